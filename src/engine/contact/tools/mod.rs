//! Contact of particles, and of the points of rigid bodies, with the exact surfaces of rigid bodies.

mod nearby;

mod contact;

mod reaction;

pub(super) use contact::SurfaceContact;
