//! Compressible neo-Hookean law with a logarithmic volume term.

use glam::DMat3;

use super::elastic_constants::ElasticConstants;
use super::elastic_parameters::elastic_parameters;
use super::error::ParameterError;
use super::law::{Hyperelastic, Material, MaterialModel};
use super::stretches::Stretches;

elastic_parameters! {
    /// Compressible neo-Hookean elasticity, P = mu (F - F^-T) + lambda ln J F^-T.
    pub struct NeoHookean {}
}

impl MaterialModel for NeoHookean {
    const NAME: &'static str = "NeoHookean";
    const REFERENCE: &'static str = "Ganzenmueller 2015, eq. 44; Bonet and Wood 2008, eq. 6.28";

    fn build(self) -> Result<Material, ParameterError> {
        let elastic = self.elastic()?;
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

    fn wave_factor(&self, stretches: &Stretches) -> f64 {
        // A wave along n has the acoustic tensor mu (n . b n) I + (mu + lambda (1 - ln J)) n (x) n, b = F
        // F^T.
        let (lambda, mu) = (self.0.lambda, self.0.shear);
        let along = mu + lambda * (1.0 - stretches.smallest_volume.ln());
        ((mu * stretches.largest.powi(2) + along) / (lambda + 2.0 * mu)).sqrt().max(1.0)
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
