//! Equations of state of solids: pressure as a function of volume and internal energy.
//!
//! J is the volume over that of the reference configuration, mu = 1/J - 1 the compression, E the internal
//! energy per reference volume. Pressure is that of the Cauchy stress, positive in compression.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::elastic_constants::ElasticConstants;
use super::error::ParameterError;
use super::stretches::Stretches;

/// Pressure as a function of volume, and of internal energy where `gamma` is above zero.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum SolidEos {
    /// p = K mu with the bulk modulus of the material.
    Linear,
    /// Mie-Grueneisen about the shock Hugoniot u_s = sound_speed + slope u_p: p = rho_0 c^2 (1 - J) (1 -
    /// gamma (1 - J)/2) / (1 - slope (1 - J))^2 + gamma E in compression, rho_0 c^2 mu + gamma E in tension.
    MieGrueneisen {
        /// Speed of weak shocks c, m/s; without it sqrt(K / rho_0).
        #[serde(default)]
        sound_speed: Option<f64>,
        /// Slope s of the Hugoniot in the plane of shock and particle speed.
        slope: f64,
        /// Grueneisen parameter; 0 leaves the energy out.
        #[serde(default)]
        gamma: f64,
    },
    /// p = c1 mu + c2 mu^2 + c3 mu^3 + gamma E; without the square in tension.
    Polynomial {
        /// Coefficient of mu, Pa; without it the bulk modulus.
        #[serde(default)]
        c1: Option<f64>,
        /// Coefficient of mu^2, Pa.
        c2: f64,
        /// Coefficient of mu^3, Pa.
        c3: f64,
        /// Grueneisen parameter; 0 leaves the energy out.
        #[serde(default)]
        gamma: f64,
    },
}

/// An equation of state with its constants, ready for use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PressureLaw {
    /// J p = -K ln J: the Kirchhoff pressure of logarithmic strain.
    Logarithmic {
        /// Bulk modulus K, Pa.
        bulk: f64,
    },
    /// p = K mu.
    Linear {
        /// Bulk modulus K, Pa.
        bulk: f64,
    },
    /// Mie-Grueneisen.
    Shock {
        /// rho_0 c^2, Pa.
        bulk: f64,
        /// s.
        slope: f64,
        /// Grueneisen parameter.
        gamma: f64,
    },
    /// Polynomial in mu.
    Polynomial {
        /// c1, c2, c3, Pa.
        coefficients: [f64; 3],
        /// Grueneisen parameter.
        gamma: f64,
    },
}

impl SolidEos {
    /// Checks the parameters for a material of bulk modulus K, Pa, and density, kg/m3.
    pub fn pressure(self, bulk: f64, density: f64) -> Result<PressureLaw, ParameterError> {
        match self {
            Self::Linear => Ok(PressureLaw::Linear { bulk }),
            Self::MieGrueneisen { sound_speed, slope, gamma } => {
                let speed = sound_speed.unwrap_or((bulk / density).sqrt());
                ParameterError::require_positive("eos.sound_speed", speed)?;
                ParameterError::require_not_negative("eos.slope", slope)?;
                ParameterError::require_not_negative("eos.gamma", gamma)?;
                Ok(PressureLaw::Shock { bulk: density * speed * speed, slope, gamma })
            }
            Self::Polynomial { c1, c2, c3, gamma } => {
                let c1 = c1.unwrap_or(bulk);
                ParameterError::require_positive("eos.c1", c1)?;
                ParameterError::require_not_negative("eos.c2", c2)?;
                ParameterError::require_not_negative("eos.c3", c3)?;
                ParameterError::require_not_negative("eos.gamma", gamma)?;
                Ok(PressureLaw::Polynomial { coefficients: [c1, c2, c3], gamma })
            }
        }
    }
}

impl PressureLaw {
    /// Grueneisen parameter: the pressure for each joule of internal energy in a cubic metre.
    #[inline(always)]
    pub fn gamma(&self) -> f64 {
        match *self {
            Self::Logarithmic { .. } | Self::Linear { .. } => 0.0,
            Self::Shock { gamma, .. } | Self::Polynomial { gamma, .. } => gamma,
        }
    }

    /// Whether the internal energy is integrated along the path.
    #[inline(always)]
    pub fn keeps_energy(&self) -> bool {
        matches!(self, Self::Shock { .. } | Self::Polynomial { .. })
    }

    /// Pressure without its part gamma E, Pa, at the volume ratio J. Where the Hugoniot has no volume so
    /// small (1 - J >= 1/slope) it is infinite.
    #[inline(always)]
    pub fn cold(&self, j: f64) -> f64 {
        let compression = 1.0 / j - 1.0;
        match *self {
            Self::Logarithmic { bulk } => -bulk * j.ln() / j,
            Self::Linear { bulk } => bulk * compression,
            Self::Shock { bulk, slope, gamma } => {
                let chi = 1.0 - j;
                if chi <= 0.0 {
                    return bulk * compression;
                }
                let rest = 1.0 - slope * chi;
                if rest <= 0.0 {
                    return f64::INFINITY;
                }
                bulk * chi / (rest * rest) * (1.0 - 0.5 * gamma * chi)
            }
            Self::Polynomial { coefficients: [c1, c2, c3], .. } => {
                let square = if compression > 0.0 { c2 } else { 0.0 };
                compression * (c1 + compression * (square + compression * c3))
            }
        }
    }

    /// Work that this pressure has stored, the integral of -p dJ from 1, J/m3 of the reference configuration;
    /// `None` where it depends on the path, because the pressure depends on the energy.
    #[inline(always)]
    pub fn stored(&self, j: f64) -> Option<f64> {
        match *self {
            Self::Logarithmic { bulk } => {
                let log = j.ln();
                Some(0.5 * bulk * log * log)
            }
            Self::Linear { bulk } => Some(bulk * (j - 1.0 - j.ln())),
            Self::Shock { .. } | Self::Polynomial { .. } => None,
        }
    }

    /// Stiffness against a change of volume seen from the reference configuration, -J d(J p)/dJ, over that at
    /// J = 1: by how much waves are faster in a compressed state. Below 1 where compression softens.
    pub fn stiffening(&self, j: f64) -> f64 {
        let kirchhoff = |j: f64| j * self.cold(j);
        let step = 1e-5;
        let modulus = |j: f64| -j * (kirchhoff(j + step) - kirchhoff(j - step)) / (2.0 * step);
        modulus(j) / modulus(1.0)
    }

    /// Factor of the stable time step at the extreme stretches of a body: stiffness seen from the reference
    /// configuration grows as 1/stretch^2, and the pressure may stiffen beside.
    pub fn step_factor(&self, elastic: &ElasticConstants, stretches: &Stretches) -> f64 {
        stretches.smallest.min(1.0) / self.wave_factor(elastic, stretches)
    }

    /// Largest speed of longitudinal waves over present lengths, over that of the undeformed material:
    /// elastic strains are small, so that plastic flow does not change it, and the pressure may stiffen.
    pub fn wave_factor(&self, elastic: &ElasticConstants, stretches: &Stretches) -> f64 {
        let stiffer = elastic.bulk * (self.stiffening(stretches.smallest_volume) - 1.0).max(0.0);
        (1.0 + stiffer / elastic.longitudinal_modulus()).sqrt()
    }
}
