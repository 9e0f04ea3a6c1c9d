//! The contacts of a scene pair by pair.

use std::collections::BTreeMap;

use super::{BodyKind, BodyPlan, SimBuilder};
use crate::scene::{Contact, Scene, TouchingPairs};

/// The contacts pair by pair, each with the index of the contact in the scene. Of the bodies that a pattern
/// such as `"*"` stands for, fluids have none, because the flow acts on bodies without it, and walls have
/// none with each other.
pub fn contact_pairs<'a>(
    scene: &'a Scene,
    bodies: &'a [BodyPlan],
) -> impl Iterator<Item = (usize, Contact)> + 'a {
    let kinds: BTreeMap<&str, BodyKind> = bodies.iter().map(|body| (body.name.as_str(), body.kind)).collect();
    let kind = move |name: &str| kinds.get(name).copied();
    scene.contact_pairs().filter(move |(number, contact)| {
        let (a, b) = &contact.between;
        let states = |name: &str| scene.contacts[*number].states(name);
        let is = |name: &str, of: BodyKind| kind(name) == Some(of);
        let are_walls = is(a, BodyKind::Boundary) && is(b, BodyKind::Boundary);
        let lacks_one =
            [a, b].into_iter().any(|name| !states(name) && (are_walls || is(name, BodyKind::Fluid)));
        !lacks_one
    })
}

impl SimBuilder<'_> {
    /// The contacts of the scene pair by pair, each with the index of the contact in the scene.
    pub fn contact_pairs(&self) -> impl Iterator<Item = (usize, Contact)> {
        contact_pairs(self.scene(), self.bodies())
    }

    /// The pairs of bodies that have a contact.
    pub fn touching_pairs(&self) -> TouchingPairs {
        TouchingPairs::new(self.contact_pairs().map(|(_, contact)| contact.between).collect())
    }
}
