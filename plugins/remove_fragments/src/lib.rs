//! Removes debris of solids: crushed particles, and pieces too small to have an interior.
//!
//! A load beyond the capacity of a material law compresses its particles until they invert and the run ends.
//! A failed body may leave single particles, whose deformation gradient is fitted to one or two neighbours
//! and has no meaning. The spacing resolves neither.

mod debris;

use meshless_engine::column;
use meshless_engine::plugin::{BodyKind, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::scene::Dimension;
use meshless_engine::world::BodyId;
use schemars::JsonSchema;
use serde::Deserialize;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<RemoveFragments>();
}

column! {
    /// Whether a particle has been crushed, or belonged to a piece that is too small, at the end of the last
    /// step: 1 or 0.
    pub struct IsDebris(u32) = "debris", "-", "1";
}

/// Removes crushed particles and small pieces of solids.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RemoveFragments {
    /// Volume over the initial volume below which a particle is removed as crushed; zero: none is.
    pub minimum_volume_ratio: f64,
    /// Pieces of fewer particles are removed; 1: none is. A piece is a set of particles connected by kernels.
    /// Default: 5 in the plane and 7 in space, a particle with its nearest neighbours.
    pub particles: Option<usize>,
}

impl Default for RemoveFragments {
    fn default() -> Self {
        Self { minimum_volume_ratio: 0.2, particles: None }
    }
}

/// Largest number of particles of a piece that is looked for.
const MAX_PARTICLES: usize = 100;

impl Plugin for RemoveFragments {
    const NAME: &'static str = "remove_fragments";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let volume = self.minimum_volume_ratio;
        if !(0.0..=0.9).contains(&volume) {
            return Err(SetupError::parameter(
                "minimum_volume_ratio",
                format!("`minimum_volume_ratio` must be from 0 to 0.9, found {volume}"),
                "it is a volume over the initial volume; particles below it are removed",
            ));
        }
        let of_dimension = if sim.dimension() == Dimension::Two { 5 } else { 7 };
        let particles = self.particles.unwrap_or(of_dimension);
        if !(1..=MAX_PARTICLES).contains(&particles) {
            return Err(SetupError::parameter(
                "particles",
                format!("`particles` must be from 1 to {MAX_PARTICLES}, found {particles}"),
                "pieces of fewer particles are removed; 1 removes crushed particles only",
            ));
        }
        let solid = |id: &BodyId| sim.body(*id).solid_law().is_ok();
        let bodies: Vec<BodyId> = sim.scope_of(BodyKind::Solid)?.iter().filter(solid).collect();
        debris::add(sim, bodies, volume, particles);
        Ok(())
    }
}
