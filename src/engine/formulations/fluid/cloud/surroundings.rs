//! The filled share of the support of a fluid particle.

use crate::linalg::{Sym3, extreme_eigenvalues};

/// The smallest eigenvalue of a moment matrix `sum_j V_j w_ij x_ij (x) x_ij` over fluids and boundary
/// particles: one inside, about a half at a surface, zero for a drop (Marrone et al., J. Comput. Phys. 229
/// (2010) 3652-3663). In a plane it is that of its two axes.
#[inline(always)]
pub fn smallest_eigenvalue(moment: &Sym3, plane: bool) -> f64 {
    if plane {
        let (mean, difference) = (0.5 * (moment.xx + moment.yy), 0.5 * (moment.xx - moment.yy));
        mean - (difference * difference + moment.xy * moment.xy).sqrt()
    } else {
        extreme_eigenvalues(moment).smallest
    }
}
