//! Wendland C6.

use super::profile::{KernelProfile, below};
use std::f64::consts::PI;

/// `f = (1 - q/2)^8 (1 + 4 q + 25/4 q^2 + 4 q^3)`, the member of the two- and three-dimensional family;
/// support 2 h.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WendlandC6;

impl KernelProfile for WendlandC6 {
    const NAME: &'static str = "wendland_c6";
    const SUPPORT: f64 = 2.0;
    const NORMALISATION: [f64; 3] = [15.0 / 16.0, 39.0 / (14.0 * PI), 1365.0 / (512.0 * PI)];
    const REFERENCE: &'static str = "Wendland 1995, Advances in Computational Mathematics 4, 389-396; \
         Dehnen & Aly 2012, Monthly Notices of the Royal Astronomical Society 425, 1068-1082";

    #[inline]
    fn value(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        let s4 = (s * s) * (s * s);
        s4 * s4 * (1.0 + q * (4.0 + q * (6.25 + 4.0 * q)))
    }

    #[inline]
    fn derivative(q: f64) -> f64 {
        -q * Self::weight(q)
    }

    #[inline]
    fn second_derivative(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        let s2 = s * s;
        5.5 * s2 * s2 * s2 * (q * (q * (20.0 * q + 3.75) - 3.0) - 1.0)
    }

    #[inline]
    fn weight(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        let s2 = s * s;
        5.5 * s2 * s2 * s2 * s * (1.0 + q * (3.5 + 4.0 * q))
    }
}
