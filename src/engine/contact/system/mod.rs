//! The systems of all contacts of a scene: one computes their forces, one adds them to the particles.

mod touching;

mod contacts;

pub(super) use contacts::add;
pub(super) use touching::Touching;
