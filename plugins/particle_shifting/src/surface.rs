//! Where the free surface is, from the neighbours alone (Marrone et al., J. Comput. Phys. 229 (2010) 3652-3663).

use meshless_engine::formulations::fluid::{FlowCloud, RowPass};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{Arithmetic, Vector};

/// Smallest eigenvalue below which a particle is at the surface or beside a hole: its neighbours are near the surface.
const OUTERMOST: f64 = 0.65;
/// Smallest eigenvalue below which it is an edge, or a drop.
const EDGE: f64 = 0.4;
/// Smallest eigenvalue above which a particle can be inside the fluid.
const INSIDE: f64 = 0.75;

/// Where a particle is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// No free surface within the support.
    Inside,
    /// Near a free surface.
    Near,
    /// At an edge of the surface, or in a drop.
    AtSurface,
}

/// Finds the places from the smallest eigenvalues of all fluid particles.
pub struct Places<'a> {
    pub cloud: &'a FlowCloud,
    pub lambda: &'a [f64],
}

impl RowPass for Places<'_> {
    type Output = Place;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> Place {
        let lambda = self.lambda;
        if lambda[i] < EDGE {
            return Place::AtSurface;
        }
        if lambda[i] < INSIDE {
            return Place::Near;
        }
        for near in self.cloud.fours(a, i, &(0..self.cloud.fluid)) {
            let weight = near.weight.lanes().0;
            if (0..4).any(|k| weight[k] > 0.0 && lambda[near.rows[k]] < OUTERMOST) {
                return Place::Near;
            }
        }
        Place::Inside
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
