//! Flow stress of Johnson and Cook.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::ParameterError;
use super::heating::room_temperature;
use super::value_and_slope::ValueAndSlope;

/// Plastic strain below which the slope of a power law is taken at this strain: it is infinite at zero.
pub(super) const MIN_STRAIN: f64 = 1e-12;

/// Hands the parameters of the flow stress, declared once, to another macro.
///
/// A scene gives them side by side with those of a material, or as its `hardening`; structs in structs would
/// change what it has to write.
macro_rules! flow_parameters {
    ($declare:ident { $($own:tt)* }) => {
        $declare! {
            [
                /// Yield stress A at the reference rate and temperature, Pa.
                a,
                /// Hardening coefficient B, Pa.
                b,
                /// Hardening exponent n.
                n,
                /// Rate coefficient C.
                #[serde(default)]
                c,
                /// Thermal exponent m.
                #[serde(default = "one")]
                m,
                /// Plastic strain rate at and below which the rate has no influence, 1/s.
                #[serde(default = "one")]
                reference_rate,
                /// Temperature at and below which temperature has no influence, K.
                #[serde(default = "room_temperature")]
                reference_temperature,
                /// Melting temperature, at which the flow stress is zero, K.
                melt_temperature,
            ]
            $($own)*
        }
    };
}

pub(super) use flow_parameters;

macro_rules! flow_stress {
    ([$($(#[$meta:meta])* $field:ident,)*]) => {
        /// Flow stress sigma_y = (a + b eps_p^n)(1 + c ln max(rate / reference_rate, 1))(1 - T*^m),
        /// T* = (T - reference_temperature) / (melt_temperature - reference_temperature) between 0 and 1.
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct JohnsonCookFlow {
            $($(#[$meta])* pub $field: f64,)*
        }

        impl JohnsonCookFlow {
            pub(super) const FIELDS: [&'static str; 8] = [$(stringify!($field)),*];
            /// The fields as errors name them where the flow stress is the `hardening` of another material.
            pub(super) const FIELDS_OF_HARDENING: [&'static str; 8] = [$(concat!("hardening.", stringify!($field))),*];
        }
    };
}

flow_parameters! { flow_stress {} }

pub(super) fn one() -> f64 {
    1.0
}

impl JohnsonCookFlow {
    /// Checks the parameters; `fields` are their names for errors.
    pub(super) fn check(&self, fields: &[&'static str; 8]) -> Result<(), ParameterError> {
        let [a, b, n, c, m, rate, reference, melt] = *fields;
        ParameterError::require_positive(a, self.a)?;
        ParameterError::require_not_negative(b, self.b)?;
        ParameterError::require_positive(n, self.n)?;
        ParameterError::require_not_negative(c, self.c)?;
        ParameterError::require_positive(m, self.m)?;
        ParameterError::require_positive(rate, self.reference_rate)?;
        ParameterError::require_positive(reference, self.reference_temperature)?;
        if self.melt_temperature.is_finite() && self.melt_temperature > self.reference_temperature {
            return Ok(());
        }
        Err(ParameterError::new(
            melt,
            format!(
                "the melt temperature must be above the reference temperature, found {} K and {} K",
                self.melt_temperature, self.reference_temperature
            ),
            "temperatures are in kelvin: add 273.15 to degrees Celsius",
        ))
    }

    /// a + b strain^n, Pa, and its derivative by the strain.
    #[inline]
    pub fn hardened(&self, strain: f64) -> ValueAndSlope {
        let power = self.b * strain.powf(self.n);
        ValueAndSlope { value: self.a + power, slope: self.n * power / strain.max(MIN_STRAIN) }
    }

    /// Factor of the plastic strain rate, 1/s, and its derivative by the rate.
    #[inline]
    pub fn rate_factor(&self, rate: f64) -> ValueAndSlope {
        if rate > self.reference_rate {
            let value = 1.0 + self.c * (rate / self.reference_rate).ln();
            ValueAndSlope { value, slope: self.c / rate }
        } else {
            ValueAndSlope { value: 1.0, slope: 0.0 }
        }
    }

    /// Factor of the temperature, K.
    #[inline]
    pub fn thermal(&self, temperature: f64) -> f64 {
        let above = temperature - self.reference_temperature;
        let homologous = above / (self.melt_temperature - self.reference_temperature);
        match homologous {
            below if below <= 0.0 => 1.0,
            above if above >= 1.0 => 0.0,
            between => 1.0 - between.powf(self.m),
        }
    }
}
