//! How much of what surrounds a fluid particle is filled.

use super::flow_cloud::FlowCloud;
use super::near::RowPass;
use crate::correction::FourMoments;
use crate::linalg::{Eigen, Sym3};
use crate::parallel::FourLanes;

/// Smallest eigenvalue of `sum_j V_j w_ij x_ij (x) x_ij` over fluids and what bounds them: one inside, about a half at a surface, zero for a
/// drop (Marrone et al., J. Comput. Phys. 229 (2010) 3652-3663).
pub struct SmallestEigenvalue<'a>(pub &'a FlowCloud);

impl RowPass for SmallestEigenvalue<'_> {
    type Output = f64;

    #[inline(always)]
    fn row<A: FourLanes>(&self, a: A, i: usize) -> f64 {
        let mut moment = FourMoments::new(a);
        for near in self.0.fours(a, i, &self.0.everything()) {
            moment.add(near.volume * near.weight, near.x_ij);
        }
        smallest_eigenvalue(moment.sum().matrix(), A::AXES == 2)
    }
}

/// The smallest eigenvalue of a moment matrix; in a plane that of its two axes.
#[inline(always)]
pub fn smallest_eigenvalue(moment: &Sym3, plane: bool) -> f64 {
    if plane {
        let (mean, difference) = (0.5 * (moment.xx + moment.yy), 0.5 * (moment.xx - moment.yy));
        mean - (difference * difference + moment.xy * moment.xy).sqrt()
    } else {
        Eigen::new(moment).values.min_element()
    }
}
