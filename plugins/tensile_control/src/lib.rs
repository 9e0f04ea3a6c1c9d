//! Tensile control (delta-plus-SPH): where the pressure is negative inside a fluid, particles neither pair nor tear.
//!
//! For p_i < 0 away from a free surface `p_i + p_j` of the pressure force becomes `p_j - p_i`: the force is less
//! `-2 p_i V_i sum_j V_j w_ij x_ij`, which is zero for evenly spread particles. What it takes has no energy and no opposite: momentum is kept
//! no better than particles are evenly spread.

use meshless_engine::formulations::fluid::{FLUID_FORCE, FlowCloud};
use meshless_engine::glam::DVec3;
use meshless_engine::linalg::Sym3;
use meshless_engine::parallel::for_each_block;
use meshless_engine::plugin::{Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{AccountKind, Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodySet, Force, Pressure, Velocity};
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
        let bodies = sim.scope_of("Fluid");
        if bodies.is_empty() {
            return Ok(());
        }
        let phases = sim.phases_of(&bodies);
        sim.add_system(
            System::new(Stage::Rates, Self::NAME, Control { bodies, sums: Vec::new() })
                .on_phases(phases)
                .after(FLUID_FORCE)
                .reads::<Pressure>()
                .reads::<Velocity>()
                .adds::<Force>(),
        );
        Ok(())
    }
}

/// Trace of the moment matrix over that inside a fluid, below which a particle is at a free surface.
const INSIDE: f64 = 0.85;

struct Control {
    bodies: BodySet,
    sums: Vec<f64>,
}

impl Run for Control {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        let cloud: &FlowCloud = &cloud;
        let whole = step.world.dimension().count() as f64;
        let account = step.ledger.account(TensileControl::NAME, AccountKind::Dissipated);
        for id in self.bodies.iter() {
            let (view, rows) = step.world.body_view(id);
            let (pressure, velocity) = (view.read::<Pressure>()?, view.read::<Velocity>()?);
            let (pressure, velocity): (&[Pressure], &[Velocity]) = (&pressure, &velocity);
            let mut force = view.write::<Force>()?;
            let power =
                for_each_block(&mut force[rows.clone()], &mut self.sums, &|first, block: &mut [Force]| {
                    let mut power = 0.0;
                    for (k, force) in block.iter_mut().enumerate() {
                        let i = rows.start + first + k;
                        let p = pressure[i].0;
                        if p >= 0.0 {
                            continue;
                        }
                        let (mut sum, mut moment) = (DVec3::ZERO, Sym3::ZERO);
                        cloud.for_each_neighbor(i, |near| {
                            let weight = near.volume * near.weight;
                            sum += near.x_ij * weight;
                            moment += Sym3::dyad(near.x_ij) * weight;
                        });
                        if moment.trace() > INSIDE * whole {
                            let change = sum * (2.0 * p * cloud.volume(i));
                            force.0 += change;
                            power += change.dot(velocity[i].0);
                        }
                    }
                    power
                });
            step.ledger.add(account, id, -power * step.clock.dt);
        }
        Ok(())
    }
}
