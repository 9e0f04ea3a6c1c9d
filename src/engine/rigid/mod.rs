//! Rigid bodies: particles that move as one, with the exact surface of their shape.

mod body;
mod constraint;
mod ellipsoid;
mod faces;
mod followed;
mod formulation;
mod inertia;
mod nodes;
mod outline;
mod prescribed;
mod rim;
mod rotation;
mod round;
mod systems;
#[cfg(test)]
mod tests;
mod wrench;

pub use body::{RIGID_BODIES, RigidBodies, RigidBody, RigidState};
pub use constraint::{Drive, DrivenBody, DrivenRotation, HalvedBody};
pub use ellipsoid::RigidEllipsoid;
pub use followed::{MovingFunction, SHORTEST_FOLLOWED, change_in_run, looked_ahead};
pub(crate) use formulation::checked_axis;
pub use formulation::{Rigid, Rotation};
pub(crate) use inertia::sphere_of;
pub use nodes::{Feature, Nodes, RigidNode};
#[cfg(test)]
pub(crate) use outline::Outline;
pub use prescribed::RigidAcceleration;
pub use rim::Rim;
pub use rotation::Inertia;
pub use round::Round;
pub(crate) use systems::{is_rigid, take_out};
pub use wrench::Wrench;
