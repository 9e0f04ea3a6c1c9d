//! How a flow turns around each particle, which friction must not feel, and how a boundary moves beside it.

mod affine;

mod spin;

mod body_gradient;

pub use affine::affine;
pub use spin::Spin;
