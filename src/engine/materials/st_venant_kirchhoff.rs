//! St Venant-Kirchhoff: linear between Green-Lagrange strain and second Piola-Kirchhoff stress.

use glam::DMat3;

use super::elastic_constants::ElasticConstants;
use super::elastic_parameters::elastic_parameters;
use super::error::ParameterError;
use super::law::{Hyperelastic, Material, MaterialModel};
use super::stretches::Stretches;

elastic_parameters! {
    /// St Venant-Kirchhoff elasticity, S = lambda tr(E) I + 2 mu E with E = (F^T F - I) / 2.
    pub struct StVenantKirchhoff {}
}

impl MaterialModel for StVenantKirchhoff {
    const NAME: &'static str = "StVenantKirchhoff";
    const REFERENCE: &'static str =
        "Ganzenmueller 2015, eqs. 17-19; eq. 19 lacks the identity (see docs/materials.md)";

    fn build(self) -> Result<Material, ParameterError> {
        let elastic = self.elastic()?;
        Ok(Material::solid(self.density, StVenantKirchhoffLaw(elastic)))
    }
}

/// The law of [`StVenantKirchhoff`].
#[derive(Clone, Copy, Debug)]
struct StVenantKirchhoffLaw(ElasticConstants);

impl Hyperelastic for StVenantKirchhoffLaw {
    const NEEDS_POSITIVE_VOLUME: bool = false;

    fn elastic(&self) -> &ElasticConstants {
        &self.0
    }

    fn stable_step_factor(&self, _smallest: f64, largest: f64) -> f64 {
        // The law stiffens in tension: dP/dF along a stretch s is (lambda + 2 mu)(3 s^2 - 1)/2. It softens in
        // compression.
        1.0 / largest.max(1.0)
    }

    fn wave_factor(&self, stretches: &Stretches) -> f64 {
        // dP/dF along a stretch s is (lambda + 2 mu)(3 s^2 - 1)/2, over lengths that have grown by s.
        let s = stretches.largest.max(1.0);
        s * (1.5 * s * s - 0.5).sqrt()
    }

    #[inline(always)]
    fn stress_and_energy(&self, f: &DMat3) -> (DMat3, f64) {
        let (lambda, mu) = (self.0.lambda, self.0.shear);
        let (a, b, c) = (f.x_axis, f.y_axis, f.z_axis);
        let (exx, eyy, ezz) = (0.5 * (a.dot(a) - 1.0), 0.5 * (b.dot(b) - 1.0), 0.5 * (c.dot(c) - 1.0));
        let (exy, exz, eyz) = (0.5 * a.dot(b), 0.5 * a.dot(c), 0.5 * b.dot(c));
        let trace = exx + eyy + ezz;
        let mean = lambda * trace;
        let (sxx, syy, szz) = (mean + 2.0 * mu * exx, mean + 2.0 * mu * eyy, mean + 2.0 * mu * ezz);
        let (sxy, sxz, syz) = (2.0 * mu * exy, 2.0 * mu * exz, 2.0 * mu * eyz);
        let p = DMat3::from_cols(
            a * sxx + b * sxy + c * sxz,
            a * sxy + b * syy + c * syz,
            a * sxz + b * syz + c * szz,
        );
        let squares = exx * exx + eyy * eyy + ezz * ezz + 2.0 * (exy * exy + exz * exz + eyz * eyz);
        (p, 0.5 * lambda * trace * trace + mu * squares)
    }
}
