//! The constants of isotropic elasticity, from any two of them.

use super::error::ParameterError;

/// Isotropic elastic constants; the bulk modulus is the three-dimensional one, in plane strain too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticConstants {
    /// Young's modulus E, Pa.
    pub young: f64,
    /// Poisson's ratio nu.
    pub poisson: f64,
    /// First Lame constant lambda, Pa.
    pub lambda: f64,
    /// Shear modulus mu, Pa.
    pub shear: f64,
    /// Bulk modulus K = lambda + 2 mu / 3, Pa.
    pub bulk: f64,
}

impl ElasticConstants {
    /// From Young's modulus, Pa, and Poisson's ratio.
    pub fn from_young_poisson(young: f64, poisson: f64) -> Self {
        let shear = young / (2.0 * (1.0 + poisson));
        let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        Self { young, poisson, lambda, shear, bulk: lambda + 2.0 / 3.0 * shear }
    }

    /// From bulk and shear modulus, Pa.
    pub fn from_bulk_shear(bulk: f64, shear: f64) -> Self {
        let young = 9.0 * bulk * shear / (3.0 * bulk + shear);
        let poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
        Self { young, poisson, lambda: bulk - 2.0 / 3.0 * shear, shear, bulk }
    }

    /// From the four optional parameters of a material in a scene: young and poisson, or bulk and shear. An
    /// error unless exactly one of these pairs is given, moduli (Pa) are positive, and -1 < poisson < 0.5.
    pub fn from_parameters(
        young: Option<f64>,
        poisson: Option<f64>,
        bulk: Option<f64>,
        shear: Option<f64>,
    ) -> Result<Self, ParameterError> {
        let pair_help = "give either `young` and `poisson` or `bulk` and `shear`";
        match (young, poisson, bulk, shear) {
            (Some(young), Some(poisson), None, None) => {
                ParameterError::require_positive("young", young)?;
                if !(poisson > -1.0 && poisson < 0.5) {
                    return Err(ParameterError::new(
                        "poisson",
                        format!("`poisson` must be between -1 and 0.5, found {poisson}"),
                        "at 0.5 the material is incompressible and its wave speed infinite; use 0.49 at most",
                    ));
                }
                Ok(Self::from_young_poisson(young, poisson))
            }
            (None, None, Some(bulk), Some(shear)) => {
                ParameterError::require_positive("bulk", bulk)?;
                ParameterError::require_positive("shear", shear)?;
                Ok(Self::from_bulk_shear(bulk, shear))
            }
            (Some(_), None, None, None) => {
                Err(ParameterError::new("young", "`poisson` is missing beside `young`", pair_help))
            }
            (None, Some(_), None, None) => {
                Err(ParameterError::new("poisson", "`young` is missing beside `poisson`", pair_help))
            }
            (None, None, Some(_), None) => {
                Err(ParameterError::new("bulk", "`shear` is missing beside `bulk`", pair_help))
            }
            (None, None, None, Some(_)) => {
                Err(ParameterError::new("shear", "`bulk` is missing beside `shear`", pair_help))
            }
            (None, None, None, None) => {
                Err(ParameterError::new("", "the elastic constants are missing", pair_help))
            }
            _ => {
                let field = if bulk.is_some() { "bulk" } else { "shear" };
                Err(ParameterError::new(
                    field,
                    "the elastic constants must be one pair, `young` and `poisson` or `bulk` and `shear`",
                    pair_help,
                ))
            }
        }
    }

    /// Modulus of plane longitudinal waves, lambda + 2 mu, Pa.
    pub fn longitudinal_modulus(&self) -> f64 {
        self.lambda + 2.0 * self.shear
    }

    /// Speed of longitudinal waves c_l, m/s, at a density in kg/m3.
    pub fn longitudinal_speed(&self, density: f64) -> f64 {
        (self.longitudinal_modulus() / density).sqrt()
    }
}
