//! Quintic B-spline: C4, wide support; little noise on disordered particles.

use super::profile::{KernelProfile, below};
use std::f64::consts::PI;

/// `f = (3 - q)^5 - 6 (2 - q)^5 + 15 (1 - q)^5`, each bracket clipped below at zero; support 3 h.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct QuinticSpline;

#[inline]
fn brackets(q: f64) -> [f64; 3] {
    [below(3.0, q), below(2.0, q), below(1.0, q)]
}

impl KernelProfile for QuinticSpline {
    const NAME: &'static str = "quintic_spline";
    const SUPPORT: f64 = 3.0;
    const NORMALISATION: [f64; 3] = [1.0 / 120.0, 7.0 / (478.0 * PI), 1.0 / (120.0 * PI)];
    const REFERENCE: &'static str = "Schoenberg 1946, Quarterly of Applied Mathematics 4, 45-99; \
         Morris, Fox & Zhu 1997, Journal of Computational Physics 136, 214-226";

    #[inline]
    fn value(q: f64) -> f64 {
        let [a, b, c] = brackets(q).map(|s| (s * s) * (s * s) * s);
        a - 6.0 * b + 15.0 * c
    }

    #[inline]
    fn derivative(q: f64) -> f64 {
        let [a, b, c] = brackets(q).map(|s| (s * s) * (s * s));
        -5.0 * (a - 6.0 * b + 15.0 * c)
    }

    #[inline]
    fn second_derivative(q: f64) -> f64 {
        let [a, b, c] = brackets(q).map(|s| s * s * s);
        20.0 * (a - 6.0 * b + 15.0 * c)
    }

    /// Below q = 1 the powers cancel: `f' = -120 q + 120 q^3 - 50 q^4` exactly, without loss of digits.
    #[inline]
    fn weight(q: f64) -> f64 {
        if q < 1.0 { 120.0 + q * q * (50.0 * q - 120.0) } else { -Self::derivative(q) / q }
    }
}
