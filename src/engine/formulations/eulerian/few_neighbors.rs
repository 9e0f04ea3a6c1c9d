//! Particles with few neighbours: tips, and what is left of a body that has come apart.
//!
//! Their M_i is small, and the gradient, corrected by its inverse, sees the distance to a single neighbour
//! as that to a whole side: the stiffness grows with M_i^-1, and a fragment of three failed particles had a
//! tenth of the stable step of a whole body. Such a particle has the share
//!
//! `s_i = min(1, 12 d / tr M_i^-1)`
//!
//! of its strain rate, and all of its spin: `L' = skew L + s sym L`. The force is the adjoint, from `skew tau
//! + s sym tau`: the power of the stress is that of the strain, and the spin of a particle that rotates with
//! its neighbours is exact, so that angular momentum is conserved.

use glam::DMat3;

use crate::linalg::Sym3;

/// Maximum mean eigenvalue of M_i^-1 of a particle that has all of its strain rate. It is 1 inside of a body,
/// 1.6 at a side, 2.8 in a corner, 9 in one of 45 degrees, and in space at most 4 in boxes and two layers.
const MAX_CORRECTION: f64 = 12.0;

/// s_i of a particle with this M_i^-1 in `axes` dimensions; one without it.
#[inline(always)]
pub(super) fn strain_share(inverse_moment: &Sym3, axes: f64) -> f64 {
    (MAX_CORRECTION * axes / inverse_moment.trace()).min(1.0)
}

/// `skew A + s sym A`.
#[inline(always)]
pub(super) fn strained(a: DMat3, share: f64) -> DMat3 {
    if share < 1.0 { 0.5 * (1.0 + share) * a - 0.5 * (1.0 - share) * a.transpose() } else { a }
}
