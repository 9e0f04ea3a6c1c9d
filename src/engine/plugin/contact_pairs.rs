//! The contacts of a scene pair by pair.

use std::sync::Arc;

use super::touching_pairs::TouchingPairs;
use super::{BodyKind, BodyPlan, SimBuilder};
use crate::scene::Scene;
use crate::world::BodyId;

/// The contacts pair by pair, each with the index of the contact in the scene. Of the bodies that a pattern
/// such as `"*"` stands for, fluids have none, because the flow acts on bodies without it, and walls have
/// none with each other.
pub fn contact_pairs<'a>(
    scene: &'a Scene,
    bodies: &'a [BodyPlan],
) -> impl Iterator<Item = (usize, [BodyId; 2])> + 'a {
    let has_contact = move |(number, pair): &(usize, [usize; 2])| {
        let is = |body: usize, kind: BodyKind| bodies[body].kind == kind;
        let are_walls = pair.iter().all(|&body| is(body, BodyKind::Boundary));
        let lacks_one = |&body: &usize| {
            (are_walls || is(body, BodyKind::Fluid)) && !scene.contacts[*number].states(&bodies[body].name)
        };
        !pair.iter().any(lacks_one)
    };
    scene.contact_pairs().filter(has_contact).map(|(number, pair)| (number, pair.map(BodyId)))
}

impl SimBuilder<'_> {
    /// The contacts of the scene pair by pair, each with the index of the contact in the scene. The first
    /// body is that which `between` names first.
    pub fn contact_pairs(&self) -> impl Iterator<Item = (usize, [BodyId; 2])> {
        contact_pairs(self.scene(), self.bodies())
    }

    /// The pairs of bodies that have a contact.
    pub fn touching_pairs(&self) -> Arc<TouchingPairs> {
        let of_scene = || {
            let pairs = self.contact_pairs().map(|(_, pair)| pair);
            Arc::new(TouchingPairs::new(self.bodies().len(), pairs))
        };
        Arc::clone(self.touching.get_or_init(of_scene))
    }
}
