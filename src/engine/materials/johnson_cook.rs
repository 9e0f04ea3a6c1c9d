//! Flow stress of Johnson and Cook, and the material that is named after it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::elastic_parameters::elastic_parameters;
use super::eos::SolidEos;
use super::hardening::{Hardening, LEAST_STRAIN};
use super::heating::Heating;
use super::j2::plastic;
use super::law::{Material, MaterialModel, ParameterError};

/// Hands the parameters of the flow stress, declared once, to another macro.
///
/// A scene gives them side by side with those of a material, or as its `hardening`; structs in structs would change what it has to write.
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
                #[serde(default = "room")]
                reference_temperature,
                /// Temperature at which the strength is gone, K.
                melt_temperature,
            ]
            $($own)*
        }
    };
}

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
            const FIELDS: [&'static str; 8] = [$(stringify!($field)),*];
            /// The fields as errors name them where the flow stress is the `hardening` of another material.
            pub(super) const FIELDS_OF_HARDENING: [&'static str; 8] = [$(concat!("hardening.", stringify!($field))),*];
        }
    };
}

macro_rules! metal {
    ([$($(#[$meta:meta])* $field:ident,)*] $($own:tt)*) => {
        elastic_parameters! {
            /// Johnson-Cook metal: J2 plasticity with the flow stress (a + b eps_p^n)(1 + c ln rate*)(1 - T*^m), heated by plastic work.
            pub struct JohnsonCook {
                $($(#[$meta])* pub $field: f64,)*
                $($own)*
            }
        }

        impl JohnsonCook {
            fn flow(&self) -> JohnsonCookFlow {
                JohnsonCookFlow { $($field: self.$field),* }
            }
        }
    };
}

flow_parameters! { flow_stress {} }

pub(super) fn one() -> f64 {
    1.0
}

/// Room temperature, K.
pub(super) fn room() -> f64 {
    293.15
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
    pub fn hardened(&self, strain: f64) -> (f64, f64) {
        let power = self.b * strain.powf(self.n);
        (self.a + power, self.n * power / strain.max(LEAST_STRAIN))
    }

    /// Factor of the plastic strain rate, 1/s, and its derivative by the rate.
    #[inline]
    pub fn rate_factor(&self, rate: f64) -> (f64, f64) {
        if rate > self.reference_rate {
            (1.0 + self.c * (rate / self.reference_rate).ln(), self.c / rate)
        } else {
            (1.0, 0.0)
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

flow_parameters! {
    metal {
        /// Specific heat, J/(kg K). Without it plastic work does not heat the metal.
        #[serde(default)]
        pub specific_heat: Option<f64>,
        /// Share of plastic work that becomes heat (Taylor-Quinney), 0 to 1.
        #[serde(default = "super::heating::usual_share")]
        pub taylor_quinney: f64,
        /// Temperature at the start, K; the reference temperature if not given.
        #[serde(default)]
        pub temperature: Option<f64>,
        /// Pressure as a function of volume; without it the Kirchhoff pressure is -K ln J.
        #[serde(default)]
        pub eos: Option<SolidEos>,
    }
}

impl MaterialModel for JohnsonCook {
    const NAME: &'static str = "JohnsonCook";
    const REFERENCE: &'static str = "G. R. Johnson and W. H. Cook 1983, 7th Int. Symp. Ballistics; return mapping: Simo and Hughes 1998, section 9.3";

    fn build(self) -> Result<Material, ParameterError> {
        let elastic = self.elastic()?;
        let flow = self.flow();
        flow.check(&JohnsonCookFlow::FIELDS)?;
        let heating = Heating {
            specific_heat: self.specific_heat,
            taylor_quinney: self.taylor_quinney,
            temperature: self.temperature.unwrap_or(self.reference_temperature),
        };
        heating.check(&Heating::FIELDS)?;
        plastic(self.density, elastic, Hardening::JohnsonCook(flow), Some(heating), self.eos)
    }
}
