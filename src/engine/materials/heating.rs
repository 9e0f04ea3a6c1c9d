//! Adiabatic heating: heat of plastic work stays in the particle.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::ParameterError;

/// Adiabatic heating: the temperature rises by taylor_quinney times the plastic work over density and
/// specific heat.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Heating {
    /// Specific heat, J/(kg K). Without it the temperature stays as it is.
    #[serde(default)]
    pub specific_heat: Option<f64>,
    /// Share of plastic work that becomes heat (Taylor-Quinney), 0 to 1.
    #[serde(default = "usual_share")]
    pub taylor_quinney: f64,
    /// Temperature at the start, K.
    #[serde(default = "room_temperature")]
    pub temperature: f64,
}

/// Room temperature, K.
pub(super) fn room_temperature() -> f64 {
    293.15
}

/// The usual share of plastic work that becomes heat.
pub(super) fn usual_share() -> f64 {
    0.9
}

impl Heating {
    pub(super) const FIELDS: [&'static str; 3] = ["specific_heat", "taylor_quinney", "temperature"];
    /// The fields as errors name them where they are below `heating`.
    pub(super) const FIELDS_OF_HEATING: [&'static str; 3] =
        ["heating.specific_heat", "heating.taylor_quinney", "heating.temperature"];

    /// Checks the parameters; `fields` are their names for errors.
    pub(super) fn check(&self, fields: &[&'static str; 3]) -> Result<(), ParameterError> {
        let [specific_heat, taylor_quinney, temperature] = *fields;
        if let Some(value) = self.specific_heat {
            ParameterError::require_positive(specific_heat, value)?;
        }
        ParameterError::require_positive(temperature, self.temperature)?;
        if (0.0..=1.0).contains(&self.taylor_quinney) {
            return Ok(());
        }
        Err(ParameterError::new(
            taylor_quinney,
            format!("`{taylor_quinney}` must be from 0 to 1, found {}", self.taylor_quinney),
            "it is the share of plastic work that becomes heat, 0.9 for most metals",
        ))
    }

    /// Rise of the temperature for each joule of plastic work in a cubic metre of the reference
    /// configuration, K m3/J.
    pub fn rise(&self, density: f64) -> f64 {
        self.specific_heat.map_or(0.0, |specific_heat| self.taylor_quinney / (density * specific_heat))
    }

    /// The same for each joule of heat.
    pub fn rise_by_heat(&self, density: f64) -> f64 {
        self.specific_heat.map_or(0.0, |specific_heat| 1.0 / (density * specific_heat))
    }
}
