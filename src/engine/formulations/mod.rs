//! Formulations: how a body's equation of motion is discretised.

pub mod fluid;
pub mod total_lagrangian;

use crate::plugin::{Registry, SetupError, SimBuilder};

/// Registers all formulations of the engine.
pub fn register(registry: &mut Registry) {
    registry
        .formulation::<total_lagrangian::TotalLagrangian>()
        .formulation::<fluid::Fluid>()
        .formulation::<fluid::Wall>();
}

/// Adds the systems that need the bodies of several formulations, once all are assembled.
///
/// # Errors
/// Bodies that do not go together.
pub fn couple(sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    fluid::add_systems(sim)
}
