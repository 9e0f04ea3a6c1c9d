//! Contact: bodies that touch each other, themselves, or tools. A law is one file and one line of
//! [`register`].
//!
//! The folders are listed in the order of their dependencies, and import only those above them.

/// Normal forces as functions of the overlap.
mod laws;

/// The force of one contact with damping and friction, its history and energy, and the time step that it
/// allows.
mod response;

/// Particles, points of rigid bodies and their surfaces in their current state.
mod bodies;

/// The active contacts among the candidates of a step, and the sums of their forces on particles.
mod active;

/// Contact of particles with particles.
mod particles;

/// Contact of particles, and of the points of rigid bodies, with the surfaces of rigid bodies.
mod tools;

/// Contact of the surfaces of deformable bodies with each other and with rigid bodies.
mod skins;

/// The systems of the step.
mod system;

/// From the contacts of a scene to these systems.
mod plan;

#[cfg(test)]
mod tests;

pub use bodies::CONTACT;
pub use laws::{ContactLaw, ContactPair, Hertz, NormalForce, Penalty, PlaneForce, Spring, Touch};
pub use laws::{damping_ratio, restitution};
pub use plan::{MakeLaw, add_systems};

use crate::plugin::Registry;

/// Registers all contact laws of the engine.
pub fn register(registry: &mut Registry) {
    registry.contact_law::<Penalty>().contact_law::<Hertz>();
}
