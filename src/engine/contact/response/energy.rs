//! The energies of the contacts of two bodies.

use super::interaction::Losses;
use crate::parallel::BlockSum;
use crate::removal::REMOVED_ENERGY;
use crate::schedule::{AccountKind, Step};
use crate::world::BodyId;

/// Account of what springs of skins held beyond those of the particles that touch in their place.
pub(in crate::contact) const CHANGE_OF_SURFACE: &str = "contact_surface";

/// Stored and dissipated energy of the contacts of two bodies in a step, J.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::contact) struct ContactEnergy {
    pub stored: f64,
    pub losses: Losses,
    /// Energy of contacts of particles that have been removed.
    pub removed: f64,
    /// Work of the forces in the kick that ends the step.
    pub ahead: f64,
    /// Energy of springs replaced by others, less that of the others.
    pub changed: f64,
}

impl ContactEnergy {
    /// Of springs in the last step of a contact that others take over from: they hold nothing more, and do
    /// not act in the kick that follows.
    pub fn given_up(self) -> Self {
        Self { stored: 0.0, changed: self.stored + self.ahead, ..self }
    }

    /// Of springs in their first step, which have taken over: they act in the kick that follows, and have not
    /// in the one before.
    pub fn taken_over(self) -> Self {
        let Losses { damping, friction, .. } = self.losses;
        Self { changed: -(self.stored + self.ahead + damping + friction), ..self }
    }
}

impl BlockSum for ContactEnergy {
    fn add(&mut self, next: &Self) {
        self.stored += next.stored;
        self.losses.add(&next.losses);
        self.removed += next.removed;
        self.ahead += next.ahead;
        self.changed += next.changed;
    }
}

/// Books the contacts of all pairs: each body has half. `stored` has a place for each body, J,
/// ascending.
pub(in crate::contact) fn book(
    step: &mut Step<'_>,
    energies: &[((BodyId, BodyId), ContactEnergy)],
    stored: &mut [(BodyId, f64)],
) {
    let contact = step.ledger.account("contact", AccountKind::Stored);
    let damping = step.ledger.account("contact_damping", AccountKind::Dissipated);
    let friction = step.ledger.account("friction", AccountKind::Dissipated);
    let bodies = || energies.iter().flat_map(|((a, b), energies)| [(*a, energies), (*b, energies)]);
    stored.iter_mut().for_each(|(_, stored)| *stored = 0.0);
    for (body, energies) in bodies() {
        let own = stored.binary_search_by_key(&body, |(other, _)| *other);
        own.into_iter().for_each(|k| stored[k].1 += 0.5 * energies.stored);
    }
    for &(body, stored) in &*stored {
        step.ledger.set(contact, body, stored);
    }
    for (body, energies) in bodies() {
        step.ledger.add(damping, body, 0.5 * energies.losses.damping);
        step.ledger.add(friction, body, 0.5 * energies.losses.friction);
        if energies.removed != 0.0 {
            let removed = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
            step.ledger.add(removed, body, 0.5 * energies.removed);
        }
        if energies.changed != 0.0 {
            let changed = step.ledger.account(CHANGE_OF_SURFACE, AccountKind::Dissipated);
            step.ledger.add(changed, body, 0.5 * energies.changed);
        }
    }
}
