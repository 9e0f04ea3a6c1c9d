//! Formulations: how a body's equation of motion is discretised.

pub mod bonded;
pub mod eulerian;
pub mod fluid;
pub mod total_lagrangian;
pub mod updated_lagrangian;

use crate::plugin::Registry;

/// Registers all formulations of the engine.
pub fn register(registry: &mut Registry) {
    registry
        .formulation::<total_lagrangian::TotalLagrangian>()
        .formulation::<updated_lagrangian::UpdatedLagrangian>()
        .formulation::<eulerian::Eulerian>()
        .formulation::<fluid::Fluid>()
        .formulation::<fluid::Wall>()
        .formulation::<crate::rigid::Rigid>();
}
