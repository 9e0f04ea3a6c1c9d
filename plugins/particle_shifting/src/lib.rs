//! Particle shifting (delta-plus-SPH): moves fluid particles a little from where they are dense to where they are sparse.
//!
//! `dx_i = -2 h v_max dt sum_j V_j (1 + 0.2 (W_ij / W(dp))^4) w_ij x_ij` over fluid and walls (Sun et al. 2017, eq. 20, with the step of this
//! engine in place of their Courant number). Near a free surface only the part along the surface is kept, at the surface
//! nothing; where that is tells the smallest eigenvalue lambda of the moment matrix `sum_j V_j w_ij x_ij (x) x_ij`.

mod surface;

use meshless_engine::formulations::fluid::{FlowCloud, displace};
use meshless_engine::glam::DVec3;
use meshless_engine::materials::ParameterError;
use meshless_engine::parallel::for_each_block;
use meshless_engine::plugin::{Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodyId, BodySet, Mass, Position, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<ParticleShifting>();
}

/// Keeps the particles of fluids evenly spread, so that flows with stagnation points form no gaps and threads.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ParticleShifting {
    /// Strength over that of the source.
    pub strength: f64,
}

impl Default for ParticleShifting {
    fn default() -> Self {
        Self { strength: 1.0 }
    }
}

impl Plugin for ParticleShifting {
    const NAME: &'static str = "particle_shifting";
    const REFERENCE: &'static str = "particle shifting: P. N. Sun, A. Colagrossi, S. Marrone, A. M. Zhang, Comput. Methods Appl. Mech. Engrg. 315 (2017) 25-49";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        ParameterError::require_not_negative("strength", self.strength)?;
        let bodies = sim.scope_of("Fluid");
        if self.strength == 0.0 || bodies.is_empty() {
            return Ok(());
        }
        let phases = sim.phases_of(&bodies);
        let work = Shifting {
            strength: self.strength,
            gravity: sim.gravity(),
            bodies,
            lambda: Vec::new(),
            moves: Vec::new(),
        };
        sim.add_system(
            System::new(Stage::PostStep, Self::NAME, work)
                .on_phases(phases)
                .reads::<Velocity>()
                .reads::<Mass>()
                .adds::<Position>(),
        );
        Ok(())
    }
}

/// Largest displacement of a step over the spacing.
const LARGEST: f64 = 0.05;
/// Strength and power of the part that keeps close particles apart.
const CLOSE: (f64, i32) = (0.2, 4);

struct Shifting {
    strength: f64,
    gravity: DVec3,
    bodies: BodySet,
    /// Smallest eigenvalues of the moment matrices, row by row of the fluid.
    lambda: Vec<f64>,
    moves: Vec<DVec3>,
}

impl Run for Shifting {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        let cloud: &FlowCloud = &cloud;
        let dimension = step.world.dimension().count();
        self.lambda.resize(cloud.fluid, 0.0);
        for_each_block(&mut self.lambda[..], &mut Vec::new(), &|first, out: &mut [f64]| {
            for (k, lambda) in out.iter_mut().enumerate() {
                *lambda = surface::smallest_eigenvalue(cloud, first + k, dimension);
            }
        });
        for id in self.bodies.clone().iter() {
            self.shift(step, cloud, id)?;
            displace(step, id, &self.moves, self.gravity, ParticleShifting::NAME)?;
        }
        Ok(())
    }
}

impl Shifting {
    fn shift(&mut self, step: &Step<'_>, cloud: &FlowCloud, id: BodyId) -> Result<(), StepError> {
        let (view, rows) = step.world.body_view(id);
        let spacing = step.world.body(id).spacing;
        let velocity = view.read::<Velocity>()?;
        let fastest = velocity[rows.clone()].iter().map(|v| v.0.length_squared()).fold(0.0, f64::max).sqrt();
        let factor = -2.0 * self.strength * cloud.kernel.smoothing_length() * fastest * step.clock.dt;
        let usual = 1.0 / cloud.kernel.value(spacing);
        let lambda = &self.lambda;
        self.moves.resize(rows.len(), DVec3::ZERO);
        for_each_block(&mut self.moves[..], &mut Vec::new(), &|first, moves: &mut [DVec3]| {
            for (k, out) in moves.iter_mut().enumerate() {
                let i = rows.start + first + k;
                *out = DVec3::ZERO;
                if lambda[i] < surface::AT_SURFACE {
                    continue;
                }
                let mut sum = DVec3::ZERO;
                cloud.for_each_neighbor(i, |near| {
                    let close = 1.0 + CLOSE.0 * (near.kernel * usual).powi(CLOSE.1);
                    sum += near.x_ij * (near.volume * near.weight * close);
                });
                let mut shift = sum * factor;
                if lambda[i] < surface::INSIDE {
                    let normal = surface::normal(cloud, lambda, i);
                    shift -= normal * normal.dot(shift);
                }
                *out = shift.clamp_length_max(LARGEST * spacing);
            }
        });
        Ok(())
    }
}
