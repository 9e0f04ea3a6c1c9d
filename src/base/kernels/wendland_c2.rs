//! Wendland C2: the usual kernel of weakly compressible fluids; it has no pairing instability.

use super::profile::{KernelProfile, below};
use std::f64::consts::PI;

/// `f = (1 - q/2)^4 (1 + 2 q)`, the member of the two- and three-dimensional family; support 2 h.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct WendlandC2;

impl KernelProfile for WendlandC2 {
    const NAME: &'static str = "wendland_c2";
    const SUPPORT: f64 = 2.0;
    const NORMALISATION: [f64; 3] = [3.0 / 4.0, 7.0 / (4.0 * PI), 21.0 / (16.0 * PI)];
    const REFERENCE: &'static str = "Wendland 1995, Advances in Computational Mathematics 4, 389-396; \
         Dehnen & Aly 2012, Monthly Notices of the Royal Astronomical Society 425, 1068-1082";

    #[inline]
    fn value(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        (s * s) * (s * s) * (1.0 + 2.0 * q)
    }

    #[inline]
    fn derivative(q: f64) -> f64 {
        -q * Self::weight(q)
    }

    #[inline]
    fn second_derivative(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        5.0 * s * s * (2.0 * q - 1.0)
    }

    #[inline]
    fn weight(q: f64) -> f64 {
        let s = 0.5 * below(2.0, q);
        5.0 * s * s * s
    }
}
