//! Neo-Hookean law with decoupled shape and volume change.

use glam::DMat3;

use super::elastic_constants::ElasticConstants;
use super::elastic_parameters::elastic_parameters;
use super::error::ParameterError;
use super::law::{Hyperelastic, Material, MaterialModel};
use super::stretches::Stretches;

elastic_parameters! {
    /// Decoupled neo-Hookean elasticity, tau = mu J^(-2/3) (b - tr(b)/3 I) + K J (J - 1) I with b = F F^T.
    pub struct DecoupledNeoHookean {}
}

impl MaterialModel for DecoupledNeoHookean {
    const NAME: &'static str = "DecoupledNeoHookean";
    const REFERENCE: &'static str =
        "Vidal, Bonet and Huerta 2007, section 2; Bonet and Wood 2008, section 6.5";

    fn build(self) -> Result<Material, ParameterError> {
        let elastic = self.elastic()?;
        Ok(Material::solid(self.density, DecoupledNeoHookeanLaw(elastic)))
    }
}

/// The law of [`DecoupledNeoHookean`].
#[derive(Clone, Copy, Debug)]
struct DecoupledNeoHookeanLaw(ElasticConstants);

impl Hyperelastic for DecoupledNeoHookeanLaw {
    const NEEDS_POSITIVE_VOLUME: bool = true;

    fn elastic(&self) -> &ElasticConstants {
        &self.0
    }

    fn wave_factor(&self, stretches: &Stretches) -> f64 {
        // A longitudinal wave along n has mu J^(-2/3) (5/9 tr b - n . b n / 3) + K J^2: at most 4/3 s^2 in
        // the bracket, b = F F^T.
        let (bulk, mu) = (self.0.bulk, self.0.shear);
        let shape = 4.0 / 3.0 * mu * stretches.largest.powi(2) * stretches.smallest_volume.powf(-2.0 / 3.0);
        let volume = bulk * stretches.largest_volume.powi(2);
        ((shape + volume) / (bulk + 4.0 / 3.0 * mu)).sqrt()
    }

    #[inline(always)]
    fn stress_and_energy(&self, f: &DMat3) -> (DMat3, f64) {
        let (bulk, mu) = (self.0.bulk, self.0.shear);
        let (a, b, c) = (f.x_axis, f.y_axis, f.z_axis);
        let cofactor = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
        let jacobian = a.dot(cofactor.x_axis);
        // ln and exp instead of powf: det F <= 0 gives NaN here too, and the watchdog stops.
        let isochoric = mu * (-2.0 / 3.0 * jacobian.ln()).exp();
        let invariant = a.dot(a) + b.dot(b) + c.dot(c);
        let volumetric = bulk * (jacobian - 1.0);
        // P = tau F^-T, and b F^-T = F: no inverse is needed but the cofactor.
        let p = *f * isochoric + cofactor * (volumetric - isochoric * invariant / (3.0 * jacobian));
        let energy = 0.5 * (isochoric * invariant - 3.0 * mu) + 0.5 * bulk * (jacobian - 1.0).powi(2);
        (p, energy)
    }
}
