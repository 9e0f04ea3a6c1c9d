//! Particle shifting (delta-plus-SPH): moves fluid particles a little from where they are dense to where they are sparse.
//!
//! `dx_i = -2 s h c_i dt sum_j V_j (1 + 0.2 (W_ij / W(dp))^4) w_ij x_ij` over fluid and walls (Sun et al. 2017, eq. 20, with the step of this
//! engine in place of their Courant number), where c_i is twice h times the shear rate of the flow at the particle, at most the largest speed. Near
//! a free surface only the part along the surface is kept, at the surface nothing.
//!
//! A shift undoes what the flow has crowded, and continuity has counted as compression. So the density follows it, on scales
//! above that of the particles.

mod follow;
mod moves;
mod surface;

use meshless_engine::formulations::fluid::{
    DensityShift, FlowCloud, SHIFTING_ENERGY, SmallestEigenvalue, displace,
};
use meshless_engine::glam::DVec3;
use meshless_engine::materials::ParameterError;
use meshless_engine::plugin::{Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::schedule::{Run, Stage, Step, StepError, System};
use meshless_engine::world::{BodySet, Density, Mass, Position, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

use surface::Place;

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
        sim.add_column_to::<DensityShift>(&bodies);
        let work = Shifting {
            strength: self.strength,
            gravity: sim.gravity(),
            bodies: bodies.clone(),
            lambda: Vec::new(),
            places: Vec::new(),
            moves: Vec::new(),
            dilation: Vec::new(),
        };
        sim.add_system(
            System::new(Stage::PostStep, Self::NAME, work)
                .on_bodies(bodies)
                .after_any("local_damping")
                .reads::<Velocity>()
                .reads::<Mass>()
                .reads::<Density>()
                .writes::<DensityShift>()
                .adds::<Position>(),
        );
        Ok(())
    }
}

struct Shifting {
    strength: f64,
    gravity: DVec3,
    bodies: BodySet,
    /// Smallest eigenvalues of the moment matrices, row by row of the fluid.
    lambda: Vec<f64>,
    /// Where the particles are to the free surface.
    places: Vec<Place>,
    /// Displacements, m.
    moves: Vec<DVec3>,
    /// What they do to the volume over the volume.
    dilation: Vec<f64>,
}

impl Run for Shifting {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        let cloud: &FlowCloud = &cloud;
        let Self { strength, gravity, bodies, lambda, places, moves, dilation } = self;
        lambda.resize(cloud.fluid, 0.0);
        places.resize(cloud.fluid, Place::Inside);
        moves.resize(cloud.fluid, DVec3::ZERO);
        dilation.resize(cloud.fluid, 0.0);
        cloud.for_each_row(0, lambda, &SmallestEigenvalue(cloud));
        cloud.for_each_row(0, places, &surface::Places { cloud, lambda });
        for id in bodies.iter() {
            moves::make(step, cloud, id, (*strength, lambda, places), moves)?;
        }
        cloud.for_each_row(0, dilation, &follow::Dilation { cloud, moves, places });
        for id in bodies.iter() {
            let (_, rows) = step.world.body_view(id);
            displace(step, id, &moves[rows], *gravity, SHIFTING_ENERGY)?;
            follow::follow(step, cloud, id, dilation)?;
        }
        Ok(())
    }
}
