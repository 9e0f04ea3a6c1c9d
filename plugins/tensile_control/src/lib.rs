//! Tensile control (delta-plus-SPH): where the pressure is negative inside a fluid, particles neither pair nor tear.
//!
//! For p_i < 0 away from a free surface `p_i + p_j` of the pressure force becomes `p_j - p_i`: the force is less
//! `-2 p_i V_i sum_j V_j w_ij x_ij`, which is zero for evenly spread particles. What it takes has no energy and no opposite: momentum is kept
//! no better than particles are evenly spread. Energy that it has given is paid back by friction between neighbours.

use std::ops::Range;

use meshless_engine::correction::{add_moment, moment_of};
use meshless_engine::formulations::fluid::{FLOW_RECORDS, FlowCloud, NearPairs, Repayment, RowPass, RowSums};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{Arithmetic, Vector, sum_over_blocks};
use meshless_engine::plugin::{BodyKind, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{AccountKind, Mode, Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodySet, Force, Mass, Pressure, Removed, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<TensileControl>();
}

/// Keeps fluids under negative pressure from tearing into threads.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TensileControl {}

impl Plugin for TensileControl {
    const NAME: &'static str = "tensile_control";
    const REFERENCE: &'static str = "tensile control: P. N. Sun, A. Colagrossi, S. Marrone, M. Antuono, A. M. Zhang, Comput. Phys. Commun. 224 (2018) 63-80";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let bodies = sim.scope_of(BodyKind::Fluid)?;
        if bodies.is_empty() {
            return Ok(());
        }
        let control = Control { bodies: bodies.clone(), changes: Vec::new(), sums: RowSums::default() };
        sim.add_system(
            System::new(Stage::Rates, Self::NAME, control)
                .on_bodies(bodies.clone())
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads::<Pressure>()
                .reads::<Velocity>()
                .adds::<Force>(),
        );
        let repayment = Repaying { bodies: bodies.clone(), repayment: Repayment::default() };
        sim.add_system(
            System::new(Stage::PostStep, "tensile_control_repayment", repayment)
                .on_bodies(bodies)
                .after_any("local_damping")
                .after_any("xsph")
                .after_any("particle_shifting")
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads::<Mass>()
                .reads::<Removed>()
                .writes::<Velocity>(),
        );
        Ok(())
    }
}

/// Trace of the moment matrix over that inside a fluid, below which a particle is at a free surface.
const INSIDE: f64 = 0.85;

struct Control {
    bodies: BodySet,
    changes: Vec<DVec3>,
    sums: RowSums,
}

impl Run for Control {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let cloud = step.resources.get::<FlowCloud>();
        let account = step.ledger.account(TensileControl::NAME, AccountKind::Dissipated);
        for id in self.bodies.iter() {
            let (view, rows) = step.world.body_view(id);
            let (pressure, velocity) = (view.read::<Pressure>()?, view.read::<Velocity>()?);
            let mut force = view.write::<Force>()?;
            self.changes.resize(rows.len(), DVec3::ZERO);
            let pass = Changes { cloud: &cloud, pressure: &pressure };
            cloud.for_each_row(rows.start, &mut self.changes, &mut self.sums, &pass);
            let slices = (&mut force[rows.clone()], &velocity[rows], &self.changes[..]);
            type Rows<'a> = (&'a mut [Force], &'a [Velocity], &'a [DVec3]);
            let power = sum_over_blocks(slices, &|_, (force, velocity, changes): Rows<'_>| {
                let mut power = 0.0;
                for ((force, v), change) in force.iter_mut().zip(velocity).zip(changes) {
                    force.0 += change;
                    power += change.dot(v.0);
                }
                power
            });
            step.ledger.add(account, id, -power * step.clock.dt);
        }
        Ok(())
    }
}

/// Pays back what the control has given.
struct Repaying {
    bodies: BodySet,
    repayment: Repayment,
}

impl Run for Repaying {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        for id in self.bodies.iter() {
            self.repayment.pay(step, &cloud, id, TensileControl::NAME)?;
        }
        Ok(())
    }
}

/// What is added to the forces.
struct Changes<'a> {
    cloud: &'a FlowCloud,
    pressure: &'a [Pressure],
}

impl RowPass<0, 4> for Changes<'_> {
    type Output = DVec3;

    fn among(&self) -> Range<usize> {
        self.cloud.everything()
    }

    fn reads(&self, _: usize) -> [DVec3; 0] {
        []
    }

    #[inline(always)]
    fn skips(&self, i: usize) -> bool {
        self.pressure[i].0 >= 0.0
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        _: &[Vector<A>; 0],
        _: &[Vector<A>; 0],
        [xx, yy, zz, sum]: &mut [Vector<A>; 4],
    ) {
        let weight = near.volume * near.weight;
        *sum = near.x_ij.mul_add(weight, *sum);
        add_moment([xx, yy, zz], weight, near.x_ij);
    }

    #[inline(always)]
    fn output(&self, i: usize, &[xx, yy, zz, sum]: &[DVec3; 4]) -> DVec3 {
        let plane = self.cloud.plane();
        let axes = if plane { 2.0 } else { 3.0 };
        let is_inside = moment_of([xx, yy, zz], plane).matrix().trace() > INSIDE * axes;
        let factor = 2.0 * self.pressure[i].0 * self.cloud.volume(i);
        if is_inside && !self.skips(i) { sum * factor } else { DVec3::ZERO }
    }
}
