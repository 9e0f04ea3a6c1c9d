//! Flow stress of a metal as a function of plastic strain, its rate, and temperature.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::ParameterError;
use super::johnson_cook_flow::{JohnsonCookFlow, MIN_STRAIN};
use super::value_and_slope::ValueAndSlope;

/// How the flow stress grows with plastic strain.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Hardening {
    /// Constant flow stress.
    Perfect {
        /// Yield stress, Pa.
        yield_stress: f64,
    },
    /// sigma_y = yield_stress + modulus eps_p.
    Linear {
        /// Yield stress, Pa.
        yield_stress: f64,
        /// Hardening modulus H = d sigma_y / d eps_p, Pa, not below zero.
        modulus: f64,
    },
    /// sigma_y = yield_stress + coefficient eps_p^exponent (Ludwik).
    Power {
        /// Yield stress, Pa.
        yield_stress: f64,
        /// Coefficient, Pa.
        coefficient: f64,
        /// Exponent n, above 0.
        exponent: f64,
    },
    /// sigma_y = yield_stress + saturation (1 - exp(-rate eps_p)) (Voce).
    Voce {
        /// Yield stress, Pa.
        yield_stress: f64,
        /// Growth of the flow stress at large strain, Pa.
        saturation: f64,
        /// Rate at which it is reached: 63 % at a strain of 1/rate.
        rate: f64,
    },
    /// sigma_y = (a + b eps_p^n)(1 + c ln max(rate / reference_rate, 1))(1 - T*^m) (Johnson and Cook).
    JohnsonCook(JohnsonCookFlow),
}

impl Hardening {
    /// Checks the parameters; their fields are named as those of `hardening`.
    pub fn check(&self) -> Result<(), ParameterError> {
        let (Self::Perfect { yield_stress }
        | Self::Linear { yield_stress, .. }
        | Self::Power { yield_stress, .. }
        | Self::Voce { yield_stress, .. }) = *self
        else {
            let Self::JohnsonCook(flow) = self else { return Ok(()) };
            return flow.check(&JohnsonCookFlow::FIELDS_OF_HARDENING);
        };
        ParameterError::require_positive("hardening.yield_stress", yield_stress)?;
        match *self {
            Self::Linear { modulus, .. } => {
                ParameterError::require_not_negative("hardening.modulus", modulus)
            }
            Self::Power { coefficient, exponent, .. } => {
                ParameterError::require_not_negative("hardening.coefficient", coefficient)?;
                ParameterError::require_positive("hardening.exponent", exponent)
            }
            Self::Voce { saturation, rate, .. } => {
                ParameterError::require_not_negative("hardening.saturation", saturation)?;
                ParameterError::require_not_negative("hardening.rate", rate)
            }
            Self::Perfect { .. } | Self::JohnsonCook(_) => Ok(()),
        }
    }

    /// Whether the flow stress depends on temperature.
    pub fn needs_temperature(&self) -> bool {
        matches!(self, Self::JohnsonCook(_))
    }

    /// Quasi-static flow stress, Pa.
    #[inline]
    pub fn static_stress(&self, strain: f64, temperature: f64) -> f64 {
        match *self {
            Self::Perfect { yield_stress } => yield_stress,
            Self::Linear { yield_stress, modulus } => yield_stress + modulus * strain,
            Self::Power { yield_stress, coefficient, exponent } => {
                yield_stress + coefficient * strain.powf(exponent)
            }
            Self::Voce { yield_stress, saturation, rate } => {
                yield_stress - saturation * (-rate * strain).exp_m1()
            }
            Self::JohnsonCook(flow) => flow.hardened(strain).value * flow.thermal(temperature),
        }
    }

    /// Flow stress, Pa, after a plastic strain of `increment` more in `dt` seconds, and its derivative by
    /// `increment`.
    #[inline]
    pub fn flow_stress(&self, strain: f64, increment: f64, dt: f64, temperature: f64) -> ValueAndSlope {
        let strain = strain + increment;
        let (value, slope) = match *self {
            Self::Perfect { yield_stress } => (yield_stress, 0.0),
            Self::Linear { yield_stress, modulus } => (yield_stress + modulus * strain, modulus),
            Self::Power { yield_stress, coefficient, exponent } => {
                let power = coefficient * strain.powf(exponent);
                (yield_stress + power, exponent * power / strain.max(MIN_STRAIN))
            }
            Self::Voce { yield_stress, saturation, rate } => {
                let rest = saturation * (-rate * strain).exp();
                (yield_stress + saturation - rest, rate * rest)
            }
            Self::JohnsonCook(flow) => {
                let hardened = flow.hardened(strain);
                let factor = flow.rate_factor(increment / dt);
                let thermal = flow.thermal(temperature);
                let slope = hardened.slope * factor.value + hardened.value * factor.slope / dt;
                (hardened.value * factor.value * thermal, slope * thermal)
            }
        };
        ValueAndSlope { value, slope }
    }
}
