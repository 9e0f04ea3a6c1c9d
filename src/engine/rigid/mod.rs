//! Rigid bodies: particles that move as one, with the exact surface of their shape.

mod body;
mod constraint;
mod faces;
mod followed;
mod formulation;
mod inertia;
mod nodes;
mod outline;
mod prescribed;
mod rotation;
mod systems;
#[cfg(test)]
mod tests;
mod wrench;

pub use body::{RIGID_BODIES, RigidBodies, RigidBody, RigidState};
pub use constraint::{Drive, DrivenBody, DrivenRotation, HalvedBody};
pub use followed::{MovingFunction, SHORTEST_FOLLOWED, change_in_run, looked_ahead};
pub(crate) use formulation::checked_axis;
pub use formulation::{Rigid, Rotation};
pub(crate) use inertia::sphere_of;
pub use nodes::{Feature, Nodes, RigidNode, Round};
pub use outline::Rim;
pub use prescribed::RigidAcceleration;
pub use rotation::Inertia;
pub(crate) use systems::{is_rigid, take_out};
pub use wrench::Wrench;
