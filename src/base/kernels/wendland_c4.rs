//! Wendland C4.

use super::profile::{KernelProfile, below};
use std::f64::consts::PI;

/// `f = (1 - q/2)^6 (1 + 3 q + 35/12 q^2)`, the member of the two- and three-dimensional family; support 2 h.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WendlandC4;

impl KernelProfile for WendlandC4 {
    const NAME: &'static str = "wendland_c4";
    const SUPPORT: f64 = 2.0;
    const NORMALISATION: [f64; 3] = [27.0 / 32.0, 9.0 / (4.0 * PI), 495.0 / (256.0 * PI)];
    const REFERENCE: &'static str = "Wendland 1995, Advances in Computational Mathematics 4, 389-396; \
         Dehnen & Aly 2012, Monthly Notices of the Royal Astronomical Society 425, 1068-1082";

    #[inline]
    fn value(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        let s2 = s * s;
        s2 * s2 * s2 * (1.0 + q * (3.0 + 35.0 / 12.0 * q))
    }

    #[inline]
    fn derivative(q: f64) -> f64 {
        -q * Self::weight(q)
    }

    #[inline]
    fn second_derivative(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        14.0 / 3.0 * (s * s) * (s * s) * (q * (8.75 * q - 2.0) - 1.0)
    }

    #[inline]
    fn weight(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        14.0 / 3.0 * (s * s) * (s * s) * s * (1.0 + 2.5 * q)
    }
}
