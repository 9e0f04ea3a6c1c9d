//! Tensile control (delta-plus-SPH): it prevents pairing and voids where the pressure is negative inside a
//! fluid.
//!
//! For p_i < 0 away from a free surface `p_i + p_j` of the pressure force becomes `p_j - p_i`: the force is
//! reduced by `-2 p_i V_i sum_j V_j w_ij x_ij`, which is zero for evenly spread particles. This term has no
//! energy and no opposite force. Each particle gives up a part of the sum of all these forces in proportion
//! to the size of its own, so that they add up to zero, and the whole term is scaled down where it would
//! supply more energy than it has dissipated.

use meshless_engine::correction::MomentMatrix;
use meshless_engine::formulations::fluid::{
    ArrangementPass, FLOW_RECORDS, FlowCloud, Interior, RowSums, smallest_eigenvalue,
};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::sum_over_blocks;
use meshless_engine::plugin::{BodyKind, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{AccountId, AccountKind, Mode, Run, Shared, Stage, Step, StepError, System};
use meshless_engine::world::{BodyId, Force, Pressure, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<TensileControl>();
}

/// Prevents voids and threads in fluids under negative pressure.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TensileControl {}

/// The bodies that are controlled.
type Controlled = Vec<BodyId>;

impl Plugin for TensileControl {
    const NAME: &'static str = "tensile_control";
    const REFERENCE: &'static str = "tensile control: P. N. Sun, A. Colagrossi, S. Marrone, M. Antuono, A. M. Zhang, Comput. Phys. Commun. 224 (2018) 63-80";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let bodies = sim.scope_of(BodyKind::Fluid)?;
        if bodies.is_empty() {
            return Ok(());
        }
        // What is inside is found for all fluids at once: one system serves all bodies, however many have the
        // plugin.
        if let Some(controlled) = sim.take_extensions::<Shared<Controlled>>().pop() {
            sim.shared_mut(controlled).extend(bodies.iter());
            sim.leave_note(controlled);
            return Ok(());
        }
        let controlled = sim.share(bodies.iter().collect::<Controlled>());
        sim.leave_note(controlled);
        let phases = sim.phases_of(&bodies);
        let control = TensileForce::new(controlled);
        sim.add_system(
            System::new(Stage::Rates, Self::NAME, control)
                .on_phases(phases)
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads::<Pressure>()
                .reads::<Velocity>()
                .adds::<Force>(),
        );
        Ok(())
    }
}

/// Arrangement of the neighbours of a particle.
#[derive(Clone, Copy, Debug, Default)]
struct Arrangement {
    /// Smallest eigenvalue of the moment matrix: one inside, about a half at a free surface.
    lambda: f64,
    /// First moment, 1/m: it points to where particles are crowded.
    first_moment: DVec3,
}

struct TensileForce {
    bodies: Shared<Controlled>,
    arrangements: Vec<Arrangement>,
    interior: Interior,
    changes: Vec<DVec3>,
    sums: RowSums,
}

impl TensileForce {
    fn new(bodies: Shared<Controlled>) -> Self {
        Self {
            bodies,
            arrangements: Vec::new(),
            interior: Interior::default(),
            changes: Vec::new(),
            sums: RowSums::default(),
        }
    }

    /// Adds the force to a body, and books its work.
    fn add_force(
        &mut self,
        step: &mut Step<'_>,
        cloud: &FlowCloud,
        id: BodyId,
        account: AccountId,
    ) -> Result<(), StepError> {
        let (view, rows) = step.world.body_view(id);
        let (pressure, velocity) = (view.read::<Pressure>()?, view.read::<Velocity>()?);
        let mut force = view.write::<Force>()?;
        self.changes.clear();
        self.changes.extend(rows.clone().map(|i| {
            let tension = if self.interior.has(i) { pressure[i].0.min(0.0) } else { 0.0 };
            self.arrangements[i].first_moment * (2.0 * tension * cloud.volume(i))
        }));
        balance(&mut self.changes);
        let both = (&velocity[rows.clone()], &self.changes[..]);
        let given = step.clock.dt
            * sum_over_blocks(both, &|_, (velocity, changes): (&[Velocity], &[DVec3])| {
                velocity.iter().zip(changes).map(|(v, change)| v.0.dot(*change)).sum::<f64>()
            });
        let share = affordable(given, step.ledger.of(account, id));
        for (force, change) in force[rows].iter_mut().zip(&self.changes) {
            force.0 += share * *change;
        }
        step.ledger.add(account, id, -share * given);
        Ok(())
    }
}

/// Makes the sum of some forces zero, N: they conserve momentum, and their power is the same in every frame.
fn balance(forces: &mut [DVec3]) {
    let (sum, sizes): (DVec3, f64) = sum_over_blocks(&forces[..], &|_, forces: &[DVec3]| {
        forces.iter().fold((DVec3::ZERO, 0.0), |(sum, sizes), f| (sum + *f, sizes + f.length()))
    });
    if sizes > 0.0 {
        forces.iter_mut().for_each(|force| *force -= sum * (force.length() / sizes));
    }
}

/// Factor of a force that would supply so much energy, J: at most the energy that it has dissipated before.
fn affordable(given: f64, taken: f64) -> f64 {
    if given > taken.max(0.0) { taken.max(0.0) / given } else { 1.0 }
}

impl Run for TensileForce {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let (cloud, bodies) = (resources.get::<FlowCloud>(), resources.of(self.bodies));
        let account = step.ledger.account(TensileControl::NAME, AccountKind::Dissipated);
        let mut tension = false;
        for &id in bodies.iter() {
            let (view, rows) = step.world.body_view(id);
            tension |= view.read::<Pressure>()?[rows].iter().any(|pressure| pressure.0 < 0.0);
        }
        if !tension {
            return Ok(());
        }
        let plane = cloud.plane();
        let output = |_: usize, moment: &MomentMatrix, first_moment: DVec3| Arrangement {
            lambda: smallest_eigenvalue(moment.matrix(), plane),
            first_moment,
        };
        self.arrangements.resize(cloud.fluid, Arrangement::default());
        let pass = ArrangementPass { cloud: &cloud, output };
        cloud.for_each_row(0, &mut self.arrangements, &mut self.sums, &pass);
        self.interior.find(&cloud, |i| self.arrangements[i].lambda);
        for &id in bodies.iter() {
            self.add_force(step, &cloud, id, account)?;
        }
        Ok(())
    }
}
