//! Compressible neo-Hookean law with a logarithmic volume term.

use glam::DMat3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::elastic_constants::ElasticConstants;
use super::law::{Hyperelastic, Material, MaterialModel, ParameterError};

/// Compressible neo-Hookean elasticity, P = mu (F - F^-T) + lambda ln J F^-T.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NeoHookean {
    /// Density rho_0, kg/m3.
    pub density: f64,
    /// Young's modulus E, Pa. Goes with `poisson`.
    #[serde(default)]
    pub young: Option<f64>,
    /// Poisson's ratio nu, -1 < nu < 0.5. Goes with `young`.
    #[serde(default)]
    pub poisson: Option<f64>,
    /// Bulk modulus K, Pa. Goes with `shear`.
    #[serde(default)]
    pub bulk: Option<f64>,
    /// Shear modulus mu, Pa. Goes with `bulk`.
    #[serde(default)]
    pub shear: Option<f64>,
}

impl MaterialModel for NeoHookean {
    const NAME: &'static str = "NeoHookean";
    const REFERENCE: &'static str = "Ganzenmueller 2015, eq. 44; Bonet and Wood 2008, eq. 6.28";

    fn build(self) -> Result<Material, ParameterError> {
        ParameterError::require_positive("density", self.density)?;
        let elastic = ElasticConstants::from_parameters(self.young, self.poisson, self.bulk, self.shear)?;
        Ok(Material::solid(self.density, NeoHookeanLaw(elastic)))
    }
}

/// The law of [`NeoHookean`].
#[derive(Clone, Copy, Debug)]
struct NeoHookeanLaw(ElasticConstants);

impl Hyperelastic for NeoHookeanLaw {
    const NEEDS_POSITIVE_VOLUME: bool = true;

    fn elastic(&self) -> &ElasticConstants {
        &self.0
    }

    #[inline(always)]
    fn stress_and_energy(&self, f: &DMat3) -> (DMat3, f64) {
        let (lambda, mu) = (self.0.lambda, self.0.shear);
        let (a, b, c) = (f.x_axis, f.y_axis, f.z_axis);
        let cofactor = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
        let jacobian = a.dot(cofactor.x_axis);
        let log_j = jacobian.ln();
        let p = *f * mu + cofactor * ((lambda * log_j - mu) / jacobian);
        let invariant = a.dot(a) + b.dot(b) + c.dot(c);
        (p, 0.5 * mu * (invariant - 3.0) - mu * log_j + 0.5 * lambda * log_j * log_j)
    }
}
