//! The names that the engine itself registers.

use crate::materials::{
    Al6061T6, Copper, DecoupledNeoHookean, FluidMaterial, Hypoelastic, J2, JohnsonCook, NeoHookean, PMMA,
    Rubber, StVenantKirchhoff, Steel, Steel42CrMo4,
};
use crate::plugin::Registry;

impl Registry {
    /// The registry of the engine itself: materials, formulations, conditions and contact laws, no plugin.
    pub fn standard() -> Self {
        Self::default()
            .with(register_materials)
            .with(crate::formulations::register)
            .with(crate::boundaries::register)
            .with(crate::contact::register)
    }
}

/// Registers all materials of the engine.
fn register_materials(registry: &mut Registry) {
    registry
        .material::<StVenantKirchhoff>()
        .material::<NeoHookean>()
        .material::<DecoupledNeoHookean>()
        .material::<FluidMaterial>()
        .material::<J2>()
        .material::<JohnsonCook>()
        .material::<Hypoelastic>()
        .material::<Al6061T6>()
        .material::<PMMA>()
        .material::<Copper>()
        .material::<Steel>()
        .material::<Steel42CrMo4>()
        .material::<Rubber>();
}
