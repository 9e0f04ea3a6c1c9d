//! Materials: laws as functions of small matrices, without any knowledge of particles.

mod decoupled_neo_hookean;
mod elastic_constants;
mod fluid;
mod law;
mod neo_hookean;
mod st_venant_kirchhoff;
mod state;
#[cfg(test)]
mod tests;

pub use decoupled_neo_hookean::DecoupledNeoHookean;
pub use elastic_constants::ElasticConstants;
pub use fluid::{EquationOfState, Fluid, FluidLaw};
pub use law::{Hyperelastic, Law, Material, MaterialModel, ParameterError, SolidLaw, StressRows};
pub use neo_hookean::NeoHookean;
pub use st_venant_kirchhoff::StVenantKirchhoff;
pub use state::{MAX_STATE, StateColumns, StateRows};

use crate::plugin::Registry;

/// Registers all materials of the engine.
pub fn register(registry: &mut Registry) {
    registry
        .material::<StVenantKirchhoff>()
        .material::<NeoHookean>()
        .material::<DecoupledNeoHookean>()
        .material::<Fluid>();
}
