//! Where the free surface is, from the neighbours alone (Marrone et al., J. Comput. Phys. 229 (2010) 3652-3663).

use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{Arithmetic, Vector};

/// Smallest eigenvalue above which a particle is inside the fluid.
pub const INSIDE: f64 = 0.75;
/// Smallest eigenvalue below which it is at the surface, or a drop.
pub const AT_SURFACE: f64 = 0.4;

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
