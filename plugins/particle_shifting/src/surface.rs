//! Where the free surface is, from the neighbours alone (Marrone et al., J. Comput. Phys. 229 (2010) 3652-3663).

use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::linalg::{Eigen, Sym3};

/// Smallest eigenvalue above which a particle is inside the fluid.
pub const INSIDE: f64 = 0.75;
/// Smallest eigenvalue below which it is at the surface, or a drop.
pub const AT_SURFACE: f64 = 0.4;

/// Smallest eigenvalue of `sum_j V_j w_ij x_ij (x) x_ij` over fluid and walls: one inside, about a half at a surface.
pub fn smallest_eigenvalue(cloud: &FlowCloud, i: usize, dimension: usize) -> f64 {
    let mut moment = Sym3::ZERO;
    cloud.for_each_neighbor(i, |near| moment += Sym3::dyad(near.x_ij) * (near.volume * near.weight));
    if dimension == 2 {
        let (mean, difference) = (0.5 * (moment.xx + moment.yy), 0.5 * (moment.xx - moment.yy));
        mean - difference.hypot(moment.xy)
    } else {
        Eigen::new(&moment).values.min_element()
    }
}

/// Unit normal of the surface, along the gradient of the smallest eigenvalue; zero where it has none.
pub fn normal(cloud: &FlowCloud, lambda: &[f64], i: usize) -> DVec3 {
    let mut gradient = DVec3::ZERO;
    cloud.for_each_neighbor(i, |near| {
        if let Some(other) = lambda.get(near.row) {
            gradient += near.x_ij * ((other - lambda[i]) * near.volume * near.weight);
        }
    });
    gradient.normalize_or_zero()
}
