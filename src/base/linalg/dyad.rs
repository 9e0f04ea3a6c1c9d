//! The dyadic product.

use glam::{DMat3, DVec3};

/// `a (x) b`.
#[inline(always)]
pub fn dyad(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
