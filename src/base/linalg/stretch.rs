//! Principal stretches in closed form.

use super::Sym3;
use glam::DMat3;
use std::f64::consts::PI;

/// Minimum and maximum principal value of a matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtremeValues {
    /// The minimum.
    pub smallest: f64,
    /// The maximum.
    pub largest: f64,
}

/// Smallest and largest eigenvalue of a symmetric matrix, by the trigonometric solution of the cubic (Smith
/// 1961, Communications of the ACM 4, 168). It has no loop. Its error is about 1e-7 of the largest eigenvalue
/// where two nearly coincide; [`super::Eigen`] computes eigenvectors and all digits. NaN gives NaN.
#[inline]
pub fn extreme_eigenvalues(a: &Sym3) -> ExtremeValues {
    let mean = a.trace() / 3.0;
    let deviator = a.deviator();
    let p = (deviator.double_dot(&deviator) / 6.0).sqrt();
    let cosine = if p == 0.0 { 0.0 } else { 0.5 * (deviator * (1.0 / p)).determinant() };
    // Rounding can put the cosine of a double eigenvalue just outside its range; the clamp preserves NaN.
    let angle = cosine.clamp(-1.0, 1.0).acos() / 3.0;
    ExtremeValues {
        smallest: mean + 2.0 * p * (angle + 2.0 * PI / 3.0).cos(),
        largest: mean + 2.0 * p * angle.cos(),
    }
}

/// Smallest and largest principal stretch of a deformation gradient: square roots of the extreme eigenvalues
/// of `F^T F`, for time-step limits; see [`extreme_eigenvalues`].
#[inline]
pub fn extreme_stretches(f: DMat3) -> ExtremeValues {
    let ExtremeValues { smallest, largest } = extreme_eigenvalues(&Sym3::gram(f));
    let root = |square: f64| if square < 0.0 { 0.0 } else { square.sqrt() };
    ExtremeValues { smallest: root(smallest), largest: root(largest) }
}
