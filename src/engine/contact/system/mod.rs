//! The systems of all contacts of a scene: one computes their forces, one adds them to the particles.

mod fragile;

mod touching;

mod apart;

mod beside_held;

mod chatter;

mod contacts;

pub(super) use contacts::{Planned, add};
pub(super) use fragile::{ContactActivity, FailingSkins};
pub(super) use touching::Touching;
