//! Contact: bodies that touch each other, themselves, or tools. A law is one file and one line of [`register`].

mod hertz;
mod images;
mod law;
mod least;
mod meetings;
mod members;
mod memory;
mod nearby;
mod node_view;
mod pace;
mod particles;
mod penalty;
mod plan;
mod reaction;
mod registry;
mod response;
mod restitution;
mod search;
mod shape;
mod sides;
mod sieve;
mod skin_between;
mod skin_foot;
mod skin_near;
mod skin_on_tool;
mod skin_pair;
mod skin_points;
mod skin_region;
mod skins_of;
mod start;
mod stiffness;
mod surface;
mod system;
mod tally;
#[cfg(test)]
mod tests;
mod touched;
mod touching;

pub use hertz::{Hertz, PlaneForce};
pub use law::{ContactLaw, ContactPair, NormalForce, Spring, Touch};
pub use penalty::Penalty;
pub use plan::{MakeLaw, add_systems};
pub use restitution::{damping_ratio, restitution};
pub use system::CONTACT;

use crate::plugin::Registry;

/// Registers all contact laws of the engine.
pub fn register(registry: &mut Registry) {
    registry.contact_law::<Penalty>().contact_law::<Hertz>();
}
