//! Quartic B-spline: C3.

use super::profile::{KernelProfile, below};
use std::f64::consts::PI;

/// `f = (5/2 - q)^4 - 5 (3/2 - q)^4 + 10 (1/2 - q)^4`, each bracket clipped below at zero; support 2.5 h.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct QuarticSpline;

#[inline]
fn brackets(q: f64) -> [f64; 3] {
    [below(2.5, q), below(1.5, q), below(0.5, q)]
}

impl KernelProfile for QuarticSpline {
    const NAME: &'static str = "quartic_spline";
    const SUPPORT: f64 = 2.5;
    const NORMALISATION: [f64; 3] = [1.0 / 24.0, 96.0 / (1199.0 * PI), 1.0 / (20.0 * PI)];
    const REFERENCE: &'static str = "Schoenberg 1946, Quarterly of Applied Mathematics 4, 45-99; \
         Liu & Liu 2003, Smoothed Particle Hydrodynamics, World Scientific";

    #[inline]
    fn value(q: f64) -> f64 {
        let [a, b, c] = brackets(q).map(|s| (s * s) * (s * s));
        a - 5.0 * b + 10.0 * c
    }

    #[inline]
    fn derivative(q: f64) -> f64 {
        let [a, b, c] = brackets(q).map(|s| s * s * s);
        -4.0 * (a - 5.0 * b + 10.0 * c)
    }

    #[inline]
    fn second_derivative(q: f64) -> f64 {
        let [a, b, c] = brackets(q).map(|s| s * s);
        12.0 * (a - 5.0 * b + 10.0 * c)
    }

    /// Below q = 1/2 the powers cancel: `f' = 24 q^3 - 30 q` exactly, without loss of digits.
    #[inline]
    fn weight(q: f64) -> f64 {
        if q < 0.5 { 30.0 - 24.0 * q * q } else { -Self::derivative(q) / q }
    }
}
