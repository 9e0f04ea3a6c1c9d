//! Desbrun's spiky kernel, whose gradient does not vanish at the centre; the kernel of total-Lagrangian
//! solids.

use super::profile::{KernelProfile, below};
use std::f64::consts::PI;

/// `f = (2 - q)^3`; support H = 2 h by convention here, so that `W = 10 / (pi H^5) (H - r)^3` in two
/// dimensions and `15 / (pi H^6) (H - r)^3` in three.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Spiky;

impl KernelProfile for Spiky {
    const NAME: &'static str = "spiky";
    const SUPPORT: f64 = 2.0;
    const NORMALISATION: [f64; 3] = [1.0 / 8.0, 5.0 / (16.0 * PI), 15.0 / (64.0 * PI)];
    const REFERENCE: &'static str = "Desbrun & Gascuel 1996, Computer Animation and Simulation '96, 61-76; \
         Ganzenmueller 2015, Computer Methods in Applied Mechanics and Engineering 286, 87-106";

    #[inline]
    fn value(q: f64) -> f64 {
        let s = below(2.0, q);
        s * s * s
    }

    #[inline]
    fn derivative(q: f64) -> f64 {
        let s = below(2.0, q);
        -3.0 * s * s
    }

    #[inline]
    fn second_derivative(q: f64) -> f64 {
        6.0 * below(2.0, q)
    }
}
