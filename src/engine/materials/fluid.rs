//! Weakly compressible fluids: pressure as a function of density, and viscosity.

use schemars::JsonSchema;
use serde::Deserialize;

use super::error::ParameterError;
use super::fluid_law::{EquationOfState, FluidLaw};
use super::law::{Law, Material, MaterialModel};

/// Weakly compressible Newtonian fluid: a liquid whose speed of sound is lowered to some ten times the speed
/// of the flow, so that its density changes by about 1 %.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Fluid")]
pub struct FluidMaterial {
    /// Density at zero pressure rho_0, kg/m3.
    pub density: f64,
    /// Speed of sound c_0, m/s. Without it: ten times the largest of the speeds at the start and of sqrt(2 g
    /// H), the speed of a fall through the height H of all fluid bodies.
    #[serde(default)]
    pub sound_speed: Option<f64>,
    /// Dynamic viscosity mu, Pa s.
    #[serde(default)]
    pub viscosity: f64,
    /// Pressure as a function of density.
    #[serde(default)]
    pub eos: EquationOfState,
}

impl MaterialModel for FluidMaterial {
    const NAME: &'static str = "Fluid";
    const REFERENCE: &'static str =
        "weakly compressible SPH: J. J. Monaghan, J. Comput. Phys. 110 (1994) 399-406";

    fn build(self) -> Result<Material, ParameterError> {
        ParameterError::require_positive("density", self.density)?;
        if let Some(sound_speed) = self.sound_speed {
            ParameterError::require_positive("sound_speed", sound_speed)?;
        }
        ParameterError::require_not_negative("viscosity", self.viscosity)?;
        if let EquationOfState::Tait { gamma } = self.eos
            && !(gamma > 1.0 && gamma <= 20.0)
        {
            let message = format!("`gamma` must be above 1 and at most 20, found {gamma}");
            return Err(ParameterError::new("eos.gamma", message, "7 is usual for water; or use `Linear`"));
        }
        let law = FluidLaw { sound_speed: self.sound_speed, viscosity: self.viscosity, eos: self.eos };
        Ok(Material { density: self.density, law: Law::Fluid(law) })
    }
}
