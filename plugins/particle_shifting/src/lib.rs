//! Particle shifting (delta-plus-SPH): moves fluid particles a little from where they are dense to where they are sparse.
//!
//! `dx_i = -2 h v_max dt sum_j V_j (1 + 0.2 (W_ij / W(dp))^4) w_ij x_ij` over fluid and walls (Sun et al. 2017, eq. 20, with the step of this
//! engine in place of their Courant number). Near a free surface only the part along the surface is kept, at the surface
//! nothing; where that is tells the smallest eigenvalue lambda of the moment matrix `sum_j V_j w_ij x_ij (x) x_ij`.

mod surface;

use meshless_engine::formulations::fluid::{FlowCloud, RowPass, SmallestEigenvalue, displace};
use meshless_engine::glam::DVec3;
use meshless_engine::materials::ParameterError;
use meshless_engine::parallel::{Arithmetic, Vector};
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
    /// Strength over that of the source. At 6 vortices keep particles even whatever their lattice at the start; at 1 square
    /// lattices break up.
    pub strength: f64,
}

impl Default for ParticleShifting {
    fn default() -> Self {
        Self { strength: 6.0 }
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
/// Strength of the part that keeps close particles apart, with the fourth power of their kernel.
const CLOSE: f64 = 0.2;

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
        self.lambda.resize(cloud.fluid, 0.0);
        cloud.for_each_row(0, &mut self.lambda, &SmallestEigenvalue(cloud));
        let Self { strength, gravity, bodies, lambda, moves } = self;
        for id in bodies.iter() {
            make_moves(step, cloud, id, (*strength, lambda), moves)?;
            displace(step, id, moves, *gravity, ParticleShifting::NAME)?;
        }
        Ok(())
    }
}

/// Makes the displacements of a body for a strength, with the smallest eigenvalues of all particles.
fn make_moves(
    step: &Step<'_>,
    cloud: &FlowCloud,
    id: BodyId,
    (strength, lambda): (f64, &[f64]),
    moves: &mut Vec<DVec3>,
) -> Result<(), StepError> {
    let (view, rows) = step.world.body_view(id);
    let spacing = step.world.body(id).spacing;
    let velocity = view.read::<Velocity>()?;
    let fastest = velocity[rows.clone()].iter().map(|v| v.0.length_squared()).fold(0.0, f64::max).sqrt();
    let factor = -2.0 * strength * cloud.kernel.smoothing_length() * fastest * step.clock.dt;
    moves.resize(rows.len(), DVec3::ZERO);
    let pass =
        Moves { cloud, lambda, factor, usual: 1.0 / cloud.kernel.value(spacing), largest: LARGEST * spacing };
    cloud.for_each_row(rows.start, moves, &pass);
    Ok(())
}

/// The displacements of the particles of one body.
struct Moves<'a> {
    cloud: &'a FlowCloud,
    lambda: &'a [f64],
    factor: f64,
    /// One over the kernel at the spacing.
    usual: f64,
    /// Largest displacement, m.
    largest: f64,
}

impl RowPass for Moves<'_> {
    type Output = DVec3;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> DVec3 {
        if self.lambda[i] < surface::AT_SURFACE {
            return DVec3::ZERO;
        }
        let mut sum = Vector::zero(a);
        for near in self.cloud.fours(a, i, &self.cloud.everything()) {
            let close = 1.0 + CLOSE * (near.kernel * self.usual).squared().squared();
            sum = near.x_ij.mul_add(near.volume * near.weight * close, sum);
        }
        let mut shift = sum.sum() * self.factor;
        if self.lambda[i] < surface::INSIDE {
            let normal = surface::normal(a, self.cloud, self.lambda, i);
            shift -= normal * normal.dot(shift);
        }
        shift.clamp_length_max(self.largest)
    }
}
