//! Particle shifting: small displacements of fluid particles from crowded to sparse places.
//!
//! Two passes over neighbours: `local` measures the arrangement and the motion of a neighbourhood;
//! `displacement` computes the displacement of each particle from it, and `response` the changes of velocity
//! and density. The README has the equations and the variants that were tried.

mod displacement;
mod local;
mod response;

use meshless_engine::formulations::fluid::{
    DensityShift, DisplacementAccount, FLOW_RECORDS, FlowCloud, Interior, Repayment, RowSums,
    SHIFTING_ENERGY, displace,
};
use meshless_engine::glam::DVec3;
use meshless_engine::materials::ParameterError;
use meshless_engine::plugin::{BodyKind, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{AccountKind, Mode, Run, Shared, Stage, Step, StepError, System};
use meshless_engine::world::{BodyId, Density, Mass, Position, Removed, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

use displacement::{Shift, ShiftInput};
use local::{Local, Locals};
use response::{Responses, ShiftResponse};

meshless_engine::column! {
    /// Change of volume by shifting, over the volume, that the density has not followed yet.
    pub struct PendingDilation(f64) = "pending_dilation", "B", "1";
}

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<ParticleShifting>();
}

/// Keeps the particles of fluids evenly spread, so that flows with stagnation points form no gaps and
/// threads.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ParticleShifting {
    /// Strength of the shift.
    pub strength: f64,
}

impl Default for ParticleShifting {
    fn default() -> Self {
        Self { strength: 6.0 }
    }
}

/// A shifted body with its strength.
type Shifted = Vec<(BodyId, f64)>;

impl Plugin for ParticleShifting {
    const NAME: &'static str = "particle_shifting";
    const REFERENCE: &'static str = "particle shifting: P. N. Sun, A. Colagrossi, S. Marrone, M. Antuono, A. M. Zhang, Comput. Methods Appl. Mech. Engrg. 348 (2019) 912-934";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        ParameterError::require_not_negative("strength", self.strength)?;
        let bodies = sim.scope_of(BodyKind::Fluid)?;
        if self.strength == 0.0 || bodies.is_empty() {
            return Ok(());
        }
        sim.add_column_to::<DensityShift>(&bodies);
        sim.leave_note(DisplacementAccount { bodies: bodies.clone(), name: SHIFTING_ENERGY });
        sim.add_column_to::<PendingDilation>(&bodies);
        let own = bodies.iter().map(|id| (id, self.strength));
        // Displacements of one fluid change the volumes of its neighbours: one system serves all bodies,
        // however many have the plugin.
        if let Some(shifted) = sim.take_extensions::<Shared<Shifted>>().pop() {
            sim.shared_mut(shifted).extend(own);
            sim.leave_note(shifted);
            return Ok(());
        }
        let shifted = sim.share(own.collect::<Shifted>());
        let phases = sim.phases_of(&bodies);
        let work = Shifting {
            gravity: sim.gravity(),
            bodies: shifted,
            fields: ShiftingFields::default(),
            repayment: Repayment::default(),
        };
        sim.leave_note(shifted);
        sim.add_system(
            System::new(Stage::PostStep, Self::NAME, work)
                .on_phases(phases)
                .after_any("local_damping")
                .after_any("xsph")
                .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
                .reads::<Mass>()
                .reads::<Density>()
                .reads::<Removed>()
                .writes::<Velocity>()
                .adds::<DensityShift>()
                .reads_near::<PendingDilation>()
                .writes::<PendingDilation>()
                .adds::<Position>(),
        );
        Ok(())
    }
}

struct Shifting {
    gravity: DVec3,
    bodies: Shared<Shifted>,
    fields: ShiftingFields,
    repayment: Repayment,
}

/// Results of the passes, row by row of the fluids: scratch memory.
#[derive(Default)]
struct ShiftingFields {
    locals: Vec<Local>,
    interior: Interior,
    shifts: Vec<Shift>,
    moves: Vec<DVec3>,
    pending: Vec<f64>,
    responses: Vec<ShiftResponse>,
    sums: RowSums,
}

impl ShiftingFields {
    fn resize(&mut self, fluid: usize) {
        self.locals.resize(fluid, Local::default());
        self.shifts.resize(fluid, Shift::default());
        self.moves.resize(fluid, DVec3::ZERO);
        self.pending.resize(fluid, 0.0);
        self.responses.resize(fluid, ShiftResponse::default());
    }
}

impl Run for Shifting {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        let cloud: &FlowCloud = &cloud;
        let bodies = resources.of(self.bodies);
        self.fields.resize(cloud.fluid);
        let ShiftingFields { locals, interior, shifts, moves, pending, responses, sums } = &mut self.fields;
        let dt = step.clock.dt;
        let spacing = bodies.iter().map(|(id, _)| step.world.body(*id).spacing).fold(0.0, f64::max);
        cloud.for_each_row(0, locals, sums, &Locals::new(cloud, spacing));
        interior.find(cloud, |i| locals[i].lambda);
        for &(id, strength) in bodies.iter() {
            let (view, rows) = step.world.body_view(id);
            let sound_speed = cloud.state(id).map_or(0.0, |state| state.sound_speed);
            let displacements = ShiftInput::new(cloud, strength, sound_speed, dt);
            let old = view.read_near::<PendingDilation>()?;
            for row in rows {
                shifts[row] = displacements.of(&locals[row], interior.has(row));
                (moves[row], pending[row]) = (shifts[row].displacement, old[row].0);
            }
        }
        let account = step.ledger.account(SHIFTING_ENERGY, AccountKind::Dissipated);
        let pass = Responses { cloud, locals, shifts, pending };
        cloud.for_each_row(0, responses, sums, &pass);
        for &(id, _) in bodies.iter() {
            let (_, rows) = step.world.body_view(id);
            let lost = response::change_velocity(step, id, responses)?;
            self.repayment.pay(step, cloud, id, SHIFTING_ENERGY)?;
            step.ledger.add(account, id, lost);
            displace(step, id, &moves[rows], self.gravity, SHIFTING_ENERGY)?;
            response::change_density(step, cloud, id, locals, responses)?;
        }
        Ok(())
    }
}
