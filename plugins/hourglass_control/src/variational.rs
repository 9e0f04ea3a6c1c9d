//! The variational form: the exact gradient of an energy.
//!
//! `U = sum_i (alpha/12) E_i V_i sum_j V_j w_ij |F_i X_ij - x_ij|^2`. F_i is the fit that makes the inner sum least, so
//! its change does not contribute to dU/dx, and the force is
//! `f_i = -(alpha/6) V_i sum_j V_j w_ij [E_i (F_i X_ij - x_ij) + E_j (F_j X_ij - x_ij)]`: linear in the pair vectors.
//! With F_i X_ij - x_ij = H_i X_ij - u_ij it folds into the pair stress, A_i -= (alpha/6) E_i H_i, and the bond stiffness,
//! k_i += (alpha/6) E_i.

use meshless_engine::formulations::total_lagrangian::{BondRows, BondTerm};

/// The variational form with its coefficient alpha.
pub struct Variational {
    /// alpha.
    pub alpha: f64,
}

impl BondTerm for Variational {
    fn add(&self, rows: &mut BondRows<'_>) -> f64 {
        let factor = self.alpha / 6.0;
        let mut energy = 0.0;
        for k in 0..rows.deformation.len() {
            let stiffness = factor * rows.modulus[k];
            rows.pair_stress.add_scaled(k, -stiffness, &rows.displacement_gradient[k]);
            rows.pair_stress.add_stiffness(k, stiffness);
            energy += 0.5 * stiffness * rows.volume[k] * rows.misfit[k];
        }
        energy
    }

    fn stiffness_factor(&self) -> f64 {
        self.alpha / 6.0
    }
}
