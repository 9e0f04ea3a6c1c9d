//! The moment matrix, summed over neighbours in SIMD lanes.

use glam::DVec3;

use super::MomentMatrix;
use crate::linalg::Sym3;
use crate::parallel::{Arithmetic, Number, Vector};

/// Adds neighbours by `V_j w_ij` (m^-2) and `x_ij` (m) to the sums of a moment matrix `sum_j V_j w_ij x_ij
/// (x) x_ij`: the upper triangle, in the order xx, xy, xz; yy, yz; zz.
#[inline(always)]
pub fn add_moment<A: Arithmetic>([x, y, z]: [&mut Vector<A>; 3], volume_weight: Number<A>, x_ij: Vector<A>) {
    let weighed = x_ij * volume_weight;
    *x = weighed.mul_add(x_ij.x, *x);
    y.y = weighed.y.mul_add(x_ij.y, y.y);
    if A::AXES == 3 {
        y.z = weighed.z.mul_add(x_ij.y, y.z);
        z.z = weighed.z.mul_add(x_ij.z, z.z);
    }
}

/// Adds neighbours by `V_j w_ij` (m^-2), `x_ij` (m) and the difference of a vector to the rows of `sum_j V_j
/// w_ij u_ij (x) x_ij`, which over the moment matrix is the gradient of that vector.
#[inline(always)]
pub fn add_gradient<A: Arithmetic>(
    [x, y, z]: [&mut Vector<A>; 3],
    volume_weight: Number<A>,
    x_ij: Vector<A>,
    u_ij: Vector<A>,
) {
    *x = x_ij.mul_add(volume_weight * u_ij.x, *x);
    *y = x_ij.mul_add(volume_weight * u_ij.y, *y);
    if A::AXES == 3 {
        *z = x_ij.mul_add(volume_weight * u_ij.z, *z);
    }
}

/// The moment matrix of the sums of [`add_moment`], in two or three dimensions.
#[inline(always)]
pub fn moment_of([x, y, z]: [DVec3; 3], plane: bool) -> MomentMatrix {
    let matrix = Sym3 { xx: x.x, yy: y.y, zz: z.z, xy: x.y, xz: x.z, yz: y.z };
    MomentMatrix::of(matrix, if plane { 2 } else { 3 })
}
