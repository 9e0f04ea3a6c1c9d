//! Contact of particles, and of the points of rigid bodies, with the exact surfaces of rigid bodies.

mod nearby;

mod reaction;

mod together;

mod share;

mod on_surface;

mod contact;

pub(super) use contact::{SlowImpact, SurfaceContact};
pub(super) use together::CoupledResponse;
