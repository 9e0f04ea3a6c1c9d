//! The variational form: the exact gradient of an energy.
//!
//! `U = sum_i (alpha/12) E_i V_i sum_j V_j w_ij |F_i X_ij - x_ij|^2`. F_i minimizes the inner sum, so that
//! its change does not contribute to dU/dx, and the force is `f_i = -(alpha/6) V_i sum_j V_j w_ij [E_i (F_i
//! X_ij - x_ij) + E_j (F_j X_ij - x_ij)]`: linear in the pair vectors. With F_i X_ij - x_ij = H_i X_ij - u_ij
//! it folds into the corrected stress, A_i -= (alpha/6) E_i H_i, and the bond stiffness, k_i += (alpha/6)
//! E_i.
//!
//! Where E_i falls, because the particle has yielded or is damaged, the energy falls without the work of a
//! force: the difference is booked as released.

use meshless_engine::parallel::{FourLanes, HotLoop, run_hot};
use meshless_engine::solids::{FoldedEnergy, FoldedRows, FoldedTerm};

use crate::resistance::AfterYield;

/// The variational form with its coefficient alpha.
pub struct Variational {
    /// alpha.
    pub alpha: f64,
    /// E_i after yield.
    pub after_yield: AfterYield,
}

impl FoldedTerm for Variational {
    fn add(&self, rows: &mut FoldedRows<'_>) -> FoldedEnergy {
        run_hot(AddBlock { term: self, rows })
    }

    fn stiffness_factor(&self) -> f64 {
        self.alpha / 6.0
    }
}

/// A block of particles, on the instruction path.
struct AddBlock<'a, 'r> {
    term: &'a Variational,
    rows: &'a mut FoldedRows<'r>,
}

impl HotLoop for AddBlock<'_, '_> {
    type Output = FoldedEnergy;

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) -> FoldedEnergy {
        let Self { term, rows } = self;
        let factor = term.alpha / 6.0;
        let mut energy = FoldedEnergy::default();
        let changes = !rows.memory.residual.is_empty();
        for k in 0..rows.deformation.len() {
            let modulus = term.after_yield.modulus(rows, k);
            let stiffness = factor * modulus;
            rows.stress.add_scaled(k, -stiffness, &rows.displacement_gradient[k]);
            rows.stress.add_stiffness(k, stiffness);
            let residual = 0.5 * rows.volume[k] * rows.residual[k];
            energy.stored += stiffness * residual;
            if changes {
                let memory = &mut rows.memory;
                let (before, error) = (memory.modulus[k], memory.residual[k]);
                if before > 0.0 {
                    // The trapezoidal rule of the leapfrog spends (E_n - E_n+1)/2 e_n . e_n+1 beyond the
                    // change of energy.
                    let both = 0.5 * rows.volume[k] * (error * rows.residual[k]).max(0.0).sqrt();
                    energy.released += factor * (before - modulus) * both;
                }
                (memory.modulus[k], memory.residual[k]) = (modulus, rows.residual[k]);
            }
        }
        energy
    }
}
