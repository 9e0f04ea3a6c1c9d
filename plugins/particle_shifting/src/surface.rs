//! Where the free surface is, from the neighbours alone (Marrone et al., J. Comput. Phys. 229 (2010) 3652-3663).

use meshless_engine::correction::FourMoments;
use meshless_engine::formulations::fluid::{FlowCloud, RowPass};
use meshless_engine::glam::DVec3;
use meshless_engine::linalg::Eigen;
use meshless_engine::parallel::{Arithmetic, Vector};

/// Smallest eigenvalue above which a particle is inside the fluid.
pub const INSIDE: f64 = 0.75;
/// Smallest eigenvalue below which it is at the surface, or a drop.
pub const AT_SURFACE: f64 = 0.4;

/// Smallest eigenvalue of `sum_j V_j w_ij x_ij (x) x_ij` over fluid and walls: one inside, about a half at a surface.
pub struct SmallestEigenvalue<'a>(pub &'a FlowCloud);

impl RowPass for SmallestEigenvalue<'_> {
    type Output = f64;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> f64 {
        let mut moment = FourMoments::new(a);
        for near in self.0.fours(a, i, &self.0.everything()) {
            moment.add(near.volume * near.weight, near.x_ij);
        }
        let moment = *moment.sum().matrix();
        if A::AXES == 2 {
            let (mean, difference) = (0.5 * (moment.xx + moment.yy), 0.5 * (moment.xx - moment.yy));
            mean - difference.hypot(moment.xy)
        } else {
            Eigen::new(&moment).values.min_element()
        }
    }
}

/// Unit normal of the surface, along the gradient of the smallest eigenvalue over the fluids; zero where it has none.
#[inline(always)]
pub fn normal<A: Arithmetic>(a: A, cloud: &FlowCloud, lambda: &[f64], i: usize) -> DVec3 {
    let mut gradient = Vector::zero(a);
    for near in cloud.fours(a, i, &(0..cloud.fluid)) {
        let change = near.number(|j| lambda[j]) - lambda[i];
        gradient = near.x_ij.mul_add(change * near.volume * near.weight, gradient);
    }
    gradient.sum().normalize_or_zero()
}
