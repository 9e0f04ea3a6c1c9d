//! The form of the paper: the error along the current bond (Ganzenmueller 2015, eqs. 31-32).
//!
//! `f_i = -sum_j (alpha/2) V_i V_j W_ij / |X_ij|^2 [E_i e_ij^i . x_ij + E_j e_ij^j . x_ij] x_ij / |x_ij|^2` with
//! `e_ij^i = F_i X_ij - x_ij`. Eq. 31 has W_ij and eq. 32 multiplies with it again; it belongs there once. The force is
//! not the gradient of an energy: its work is booked as dissipated, and may be negative.

use meshless_engine::pair::{Pair, PairTerm, Rates};
use meshless_engine::world::{DeformationGradient, HourglassModulus};

/// The form of the paper for one body.
pub struct Ganzenmueller2015 {
    /// alpha.
    pub alpha: f64,
    /// Density rho_0, kg/m3.
    pub density: f64,
}

impl PairTerm for Ganzenmueller2015 {
    type ReadI = (DeformationGradient, HourglassModulus);
    type ReadJ = (DeformationGradient, HourglassModulus);

    #[inline]
    fn pair(&self, pair: &Pair, (f_i, e_i): &Self::ReadI, (f_j, e_j): &Self::ReadJ, rates: &mut Rates) {
        let weight = 0.5 * self.alpha * pair.volume_j * pair.kernel / pair.reference_distance.powi(2);
        rates.stiffness += weight * (e_i.0 + e_j.0) / self.density;
        // A bond of no length has no direction; the variational form has no such gap.
        if pair.distance > 0.0 {
            let along = |f: &DeformationGradient| (f.0 * pair.reference_x_ij - pair.x_ij).dot(pair.x_ij);
            let error = e_i.0 * along(f_i) + e_j.0 * along(f_j);
            rates.force -= pair.x_ij * (weight * pair.volume_i * error / pair.distance.powi(2));
        }
    }
}
