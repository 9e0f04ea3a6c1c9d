//! The stiffness form, for bodies whose weights belong to the current configuration (Mohseni-Mofidi and
//! Bierwisch 2020, eq. 32).
//!
//! `f_i = -xi sum_j V_i V_j (E_i + E_j)/2 W_ij / |X_ij|^2 (e_ij . x_ij) x_ij / |x_ij|^2` with the hourglass
//! residual since the start, `e_ij = (F_i + F_j)/2 X_ij - x_ij`: attraction where a pair is too long. In the
//! paper the sign is that for pair vectors from i to j, and E is Young's modulus in plastic flow too. The
//! force is along the bond, so that momentum and angular momentum are conserved; it has no energy, and its
//! work is booked.

use meshless_engine::pair::{Pair, PairTerm, Rates};
use meshless_engine::parallel::{Arithmetic, Matrix, Number};
use meshless_engine::world::{DeformationGradient, HourglassModulus};

/// The stiffness form for one body.
pub struct Stiffness {
    /// xi.
    pub xi: f64,
    /// Density rho_0, kg/m3.
    pub density: f64,
}

impl PairTerm for Stiffness {
    type ReadI = (DeformationGradient, HourglassModulus);
    type ReadJ = (DeformationGradient, HourglassModulus);

    const READS_VELOCITY: bool = false;
    const NEEDS_REFERENCE: bool = true;

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (f_i, e_i): (Matrix<A>, Number<A>),
        (f_j, e_j): (Matrix<A>, Number<A>),
        rates: &mut Rates<A>,
    ) {
        let modulus = 0.5 * self.xi * (e_i + e_j);
        let stiffness = modulus * pair.volume_j * pair.kernel / pair.reference_distance_squared();
        rates.stiffness += stiffness * (1.0 / self.density);
        let error = (f_i + f_j) * pair.reference_x_ij * 0.5 - pair.x_ij;
        let along = error.dot(pair.x_ij) / pair.distance_squared();
        rates.force -= pair.x_ij * (stiffness * pair.volume_i * along);
    }
}
