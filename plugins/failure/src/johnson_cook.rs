//! Failure strain of Johnson and Cook.

use meshless_engine::materials::ParameterError;
use schemars::JsonSchema;
use serde::Deserialize;

/// Failure strain eps_f = (d1 + d2 exp(d3 s*)) (1 + d4 ln max(rate / reference_rate, 1)) (1 + d5 T*), not
/// below `minimum_strain`; s* = mean stress / von Mises stress, T* = (T - reference_temperature) /
/// (melt_temperature - reference_temperature) from 0 to 1.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JohnsonCookFailure {
    /// Strain d1.
    pub d1: f64,
    /// Strain d2.
    pub d2: f64,
    /// Coefficient d3 of the triaxiality in the exponent.
    pub d3: f64,
    /// Coefficient d4 of the plastic strain rate.
    #[serde(default)]
    pub d4: f64,
    /// Coefficient d5 of the temperature; it acts where the material has one.
    #[serde(default)]
    pub d5: f64,
    /// Plastic strain rate at and below which the rate has no influence, 1/s.
    #[serde(default = "one")]
    pub reference_rate: f64,
    /// Temperature at and below which temperature has no influence, K.
    #[serde(default = "room_temperature")]
    pub reference_temperature: f64,
    /// Temperature at and above which T* is 1, K. Needed with `d5`.
    #[serde(default)]
    pub melt_temperature: Option<f64>,
    /// Minimum failure strain: fits of the constants turn negative at high triaxiality.
    #[serde(default = "default_minimum_strain")]
    pub minimum_strain: f64,
}

fn one() -> f64 {
    1.0
}

fn room_temperature() -> f64 {
    293.15
}

fn default_minimum_strain() -> f64 {
    1e-3
}

impl JohnsonCookFailure {
    /// Checks the parameters.
    pub(crate) fn check(&self) -> Result<(), ParameterError> {
        for (field, value) in [
            ("criterion.d1", self.d1),
            ("criterion.d2", self.d2),
            ("criterion.d3", self.d3),
            ("criterion.d4", self.d4),
            ("criterion.d5", self.d5),
        ] {
            if !value.is_finite() {
                return Err(ParameterError::new(
                    field,
                    format!("`{field}` is {value}"),
                    "give a finite number",
                ));
            }
        }
        ParameterError::require_positive("criterion.reference_rate", self.reference_rate)?;
        ParameterError::require_positive("criterion.reference_temperature", self.reference_temperature)?;
        ParameterError::require_positive("criterion.minimum_strain", self.minimum_strain)?;
        let melts = self.melt_temperature.is_some_and(|melt| melt > self.reference_temperature);
        if self.d5 == 0.0 || melts {
            return Ok(());
        }
        let given = self.melt_temperature.is_some();
        Err(ParameterError::new(
            if given { "criterion.melt_temperature" } else { "criterion" },
            "`criterion.d5` needs `criterion.melt_temperature` above `criterion.reference_temperature`",
            "temperatures are in kelvin; leave `d5` out where temperature plays no part",
        ))
    }

    /// The failure strain at a triaxiality s*, plastic strain rate, 1/s, and temperature, K.
    pub fn at(&self, triaxiality: f64, rate: f64, temperature: f64) -> f64 {
        let shape = self.d1 + self.d2 * (self.d3 * triaxiality).exp();
        let fast = 1.0 + self.d4 * (rate / self.reference_rate).max(1.0).ln();
        let hot = self.melt_temperature.map_or(0.0, |melt| {
            let above = temperature - self.reference_temperature;
            (above / (melt - self.reference_temperature)).clamp(0.0, 1.0)
        });
        // `max` also turns what is not a number into the minimum strain: the particle fails, the run goes on.
        (shape * fast * (1.0 + self.d5 * hot)).max(self.minimum_strain)
    }
}
