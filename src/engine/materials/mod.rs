//! Materials: laws as functions of small matrices, independent of particles.

mod decoupled_neo_hookean;
mod elastic_constants;
mod elastic_parameters;
mod eos;
mod eos_state;
#[cfg(test)]
mod eos_tests;
mod error;
mod fluid;
mod fluid_law;
mod hardening;
mod heat_state;
mod heating;
mod hypoelastic;
#[cfg(test)]
mod hypoelastic_tests;
mod j2;
#[cfg(test)]
mod j2_tests;
mod jaumann;
mod johnson_cook;
mod johnson_cook_flow;
mod law;
mod library;
mod neo_hookean;
mod return_mapping;
#[cfg(test)]
mod specimen;
mod st_venant_kirchhoff;
mod state;
mod stretches;
#[cfg(test)]
mod tests;
mod value_and_slope;
mod viscous_heat;

pub use decoupled_neo_hookean::DecoupledNeoHookean;
pub use elastic_constants::ElasticConstants;
pub use eos::{PressureLaw, SolidEos};
pub use error::ParameterError;
pub use fluid::FluidMaterial;
pub use fluid_law::{EquationOfState, FluidLaw};
pub use hardening::Hardening;
pub use heating::Heating;
pub use hypoelastic::Hypoelastic;
pub use j2::J2;
pub use jaumann::{HypoelasticJ2, HypoelasticState, velocity_gradient_step};
pub use johnson_cook::JohnsonCook;
pub use johnson_cook_flow::JohnsonCookFlow;
pub use law::{Hyperelastic, Law, Material, MaterialModel, SolidLaw, StressRows};
pub use library::{Al6061T6, Copper, PMMA, Rubber, Steel, Steel42CrMo4};
pub use neo_hookean::NeoHookean;
pub use return_mapping::Trial;
pub use st_venant_kirchhoff::StVenantKirchhoff;
pub use state::{MAX_STATE, StateColumns, StateRows};
pub use stretches::Stretches;
pub use value_and_slope::ValueAndSlope;
