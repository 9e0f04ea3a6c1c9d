//! Hourglass control of total-Lagrangian bodies.
//!
//! The deformation gradient of a particle is a mean over its neighbourhood; motions that leave the mean as it is, the
//! zero-energy or hourglass modes, meet no resistance from stress. The control resists the error of the mean,
//! `e_ij = F_i X_ij - x_ij`.

mod ganzenmueller_2015;
mod variational;

use ganzenmueller_2015::Ganzenmueller2015;
use meshless_engine::materials::ParameterError;
use meshless_engine::plugin::{Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::world::BodySet;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use variational::Variational;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<HourglassControl>();
}

/// Resists hourglass modes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HourglassControl {
    /// How the error of the mean deformation is resisted.
    pub form: Form,
    /// Coefficient alpha of the resistance. Default: 5 of `Variational`, 25 of `Ganzenmueller2015`.
    pub alpha: Option<f64>,
}

impl Default for HourglassControl {
    fn default() -> Self {
        Self { form: Form::Variational, alpha: None }
    }
}

/// Forms of the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Form {
    /// The whole error vector, with the weights of the deformation gradient: the exact gradient of an energy.
    Variational,
    /// The error along the bond (Ganzenmueller 2015, eqs. 31-32). It has no energy, and is booked as work.
    Ganzenmueller2015,
}

impl Plugin for HourglassControl {
    const NAME: &'static str = "hourglass_control";
    const REFERENCE: &'static str = "hourglass control: G. C. Ganzenmueller, Comput. Methods Appl. Mech. Engrg. 286 (2015) 87-106, in variational form";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let bodies = sim.scope_of("TotalLagrangian");
        let default = match self.form {
            Form::Variational => 5.0,
            Form::Ganzenmueller2015 => 25.0,
        };
        let alpha = self.alpha.unwrap_or(default);
        ParameterError::require_not_negative("alpha", alpha)?;
        if alpha == 0.0 {
            return Ok(());
        }
        match self.form {
            Form::Variational => sim.add_bond_term(bodies, "hourglass", Variational { alpha }),
            Form::Ganzenmueller2015 => {
                for id in bodies.iter() {
                    let body = sim.body(id);
                    let young = body.solid_law()?.elastic().young;
                    let term = Ganzenmueller2015 { alpha, young, density: body.material.density };
                    sim.add_pair_term(BodySet::new([id]), "hourglass_work", term);
                }
            }
        }
        Ok(())
    }
}
