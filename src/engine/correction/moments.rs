//! The moment matrix of a row of neighbours, four at a time.

use super::MomentMatrix;
use crate::linalg::Sym3;
use crate::parallel::{FourLanes, Number, Vector};

/// Four partial sums of a moment matrix `sum_j V_j w_ij x_ij (x) x_ij`.
#[derive(Clone, Copy)]
pub struct FourMoments<A: FourLanes> {
    /// Products of a component with all of those from it on: xx, xy, xz; yy, yz; zz.
    products: [Vector<A>; 3],
}

impl<A: FourLanes> FourMoments<A> {
    /// The sums of no neighbours.
    #[inline(always)]
    pub fn new(a: A) -> Self {
        Self { products: [Vector::zero(a); 3] }
    }

    /// Adds four neighbours by `V_j w_ij` (m^-2) and `x_ij` (m).
    #[inline(always)]
    pub fn add(&mut self, volume_weight: Number<A>, x_ij: Vector<A>) {
        let [x, y, z] = &mut self.products;
        let weighed = x_ij * volume_weight;
        *x = weighed.mul_add(x_ij.x, *x);
        y.y = weighed.y.mul_add(x_ij.y, y.y);
        if A::AXES == 3 {
            y.z = weighed.z.mul_add(x_ij.y, y.z);
            z.z = weighed.z.mul_add(x_ij.z, z.z);
        }
    }

    /// The moment matrix, of the dimension that the instruction path has.
    #[inline(always)]
    pub fn sum(self) -> MomentMatrix {
        let [x, y, z] = self.products;
        let (x, y, z) = (x.sum(), y.sum(), z.sum());
        MomentMatrix::of(Sym3 { xx: x.x, yy: y.y, zz: z.z, xy: x.y, xz: x.z, yz: y.z }, A::AXES)
    }
}
