//! Stabilization of solids by differences of second derivatives.
//!
//! Motions that do not change the averaged deformation gradient cause no stress. They change a second
//! derivative of the positions, but not the gradient of the gradient. The stabilization resists the
//! difference of the two. The engine computes it ([`HessianDifference`]), with the neighbours of the
//! formulation.

use meshless_engine::materials::ParameterError;
use meshless_engine::plugin::{Offer, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::solids::{HessianDifference, HessianForm};
use meshless_engine::world::{BodyId, Column, Damage};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<HessianStabilization>();
}

/// Resists differences of second derivatives.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HessianStabilization {
    /// Form of the stabilization.
    pub form: DifferenceForm,
    /// Coefficient eta; the stiffness grows with its square.
    pub eta: f64,
}

impl Default for HessianStabilization {
    fn default() -> Self {
        Self { form: DifferenceForm::FrameIndifferent, eta: 0.3 }
    }
}

/// Forms of the stabilization.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum DifferenceForm {
    /// The difference of two Laplacians of the positions stores energy: no direction counts more than
    /// another.
    FrameIndifferent,
    /// The difference of two second derivatives, times a vector whose components are all the smoothing
    /// length, is added to the deformation gradient (Vidal, Bonet, Huerta 2007, eqs. 17-21): modes across the
    /// diagonal are not resisted.
    Vidal2007,
}

/// Largest coefficient that the step is made for.
const MAX_ETA: f64 = 5.0;

impl Plugin for HessianStabilization {
    const NAME: &'static str = "hessian_stabilization";
    const REFERENCE: &'static str = "stabilization by differences of Hessians: Y. Vidal, J. Bonet, A. Huerta, Int. J. Numer. Methods Engng. 69 (2007) 2687-2710";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let bodies = sim.scope_offering(Offer::HessianDifferences)?;
        ParameterError::require_not_negative("eta", self.eta)?;
        if self.eta > MAX_ETA {
            let message = format!("`eta` must be at most {MAX_ETA}, found {}", self.eta);
            return Err(SetupError::parameter("eta", message, "0.3 is usual, 1.5 is strong"));
        }
        if self.eta == 0.0 {
            return Ok(());
        }
        let form = match self.form {
            DifferenceForm::FrameIndifferent => HessianForm::FrameIndifferent,
            DifferenceForm::Vidal2007 => HessianForm::Vidal2007,
        };
        let can_fail = |id: BodyId| sim.columns(sim.body(id).phase).get(Damage::NAME).is_some();
        if let Some(id) = bodies.iter().find(|&id| form == HessianForm::Vidal2007 && can_fail(id)) {
            let message = format!("body `{}` can fail, and this form acts across cracks", sim.body(id).name);
            return Err(SetupError::parameter("form", message, "use `FrameIndifferent`"));
        }
        HessianDifference { eta: self.eta, form }.add(bodies, sim);
        Ok(())
    }
}
