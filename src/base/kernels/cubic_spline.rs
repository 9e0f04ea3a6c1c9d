//! Cubic B-spline: C2, the usual kernel of Eulerian-kernel solids.

use super::profile::{KernelProfile, below};
use std::f64::consts::PI;

/// `f = (2 - q)^3 - 4 (1 - q)^3`, each bracket clipped below at zero; support 2 h.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CubicSpline;

impl KernelProfile for CubicSpline {
    const NAME: &'static str = "cubic_spline";
    const SUPPORT: f64 = 2.0;
    const NORMALISATION: [f64; 3] = [1.0 / 6.0, 5.0 / (14.0 * PI), 1.0 / (4.0 * PI)];
    const REFERENCE: &'static str = "Monaghan & Lattanzio 1985, Astronomy and Astrophysics 149, 135-143";

    #[inline]
    fn value(q: f64) -> f64 {
        let (a, b) = (below(2.0, q), below(1.0, q));
        a * a * a - 4.0 * b * b * b
    }

    #[inline]
    fn derivative(q: f64) -> f64 {
        let (a, b) = (below(2.0, q), below(1.0, q));
        12.0 * b * b - 3.0 * a * a
    }

    #[inline]
    fn second_derivative(q: f64) -> f64 {
        6.0 * below(2.0, q) - 24.0 * below(1.0, q)
    }

    #[inline]
    fn weight(q: f64) -> f64 {
        // Both quotients are computed without a branch; the second one is meaningless at q = 0.
        let (near, far) = (12.0 - 9.0 * q, 3.0 * below(2.0, q) * (2.0 / q - 1.0));
        if q < 1.0 { near } else { far }
    }
}
