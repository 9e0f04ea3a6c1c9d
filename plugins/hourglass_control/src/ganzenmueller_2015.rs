//! The form of the paper: the residual along the current bond (Ganzenmueller 2015, eqs. 31-32).
//!
//! `f_i = -sum_j (alpha/2) V_i V_j W_ij / |X_ij|^2 [E_i e_ij^i . x_ij + E_j e_ij^j . x_ij] x_ij / |x_ij|^2`
//! with `e_ij^i = F_i X_ij - x_ij`. W_ij occurs in eq. 31 and again as a factor in eq. 32; once is correct.
//! The force is not the gradient of an energy: its work is booked as dissipated, and may be negative.

use std::marker::PhantomData;

use glam::DMat3;
use meshless_engine::pair::{Pair, PairTerm, Rates};
use meshless_engine::parallel::{Arithmetic, Matrix, Number};
use meshless_engine::world::{Column, HourglassModulus};

/// The form of the paper for one body; `F` is the column of the deformation gradient.
pub struct Ganzenmueller2015<F> {
    /// alpha.
    pub alpha: f64,
    /// Density rho_0, kg/m3.
    pub density: f64,
    pub measure: PhantomData<F>,
}

impl<F: Column<Value = DMat3>> PairTerm for Ganzenmueller2015<F> {
    type ReadI = (F, HourglassModulus);
    type ReadJ = (F, HourglassModulus);

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
        let weight = 0.5 * self.alpha * pair.volume_j * pair.kernel / pair.reference_distance_squared();
        rates.stiffness += weight * (e_i + e_j) / self.density;
        let (image_i, image_j) = (f_i * pair.reference_x_ij, f_j * pair.reference_x_ij);
        let along_i = (image_i - pair.x_ij).dot(pair.x_ij);
        let along_j = (image_j - pair.x_ij).dot(pair.x_ij);
        // A bond of no length has no direction, and no force; the variational form has no such gap.
        let error = (e_i * along_i + e_j * along_j) / pair.distance_squared();
        rates.force -= pair.x_ij * (weight * pair.volume_i * error);
    }
}
