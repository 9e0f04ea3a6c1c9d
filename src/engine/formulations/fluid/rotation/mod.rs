//! The local rotation of a flow, which must not cause friction, and the velocity gradient of boundaries.

mod affine;

mod spin;

mod body_gradient;

pub use affine::{affine, axial};
pub use spin::{Spin, rotation};
