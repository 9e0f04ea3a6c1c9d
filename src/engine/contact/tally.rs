//! The energies of the contacts of two bodies.

use super::response::Losses;
use crate::parallel::BlockSum;
use crate::removal::REMOVED_ENERGY;
use crate::schedule::{AccountKind, Step};
use crate::world::BodyId;

/// What the contacts of two bodies hold and have lost in a step, J.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub stored: f64,
    pub losses: Losses,
    /// What contacts of particles held that have been taken out.
    pub removed: f64,
}

impl BlockSum for Tally {
    fn add(&mut self, next: &Self) {
        self.stored += next.stored;
        self.losses.add(&next.losses);
        self.removed += next.removed;
    }
}

/// Books the contacts of all pairs: each body has half.
pub(super) fn book(step: &mut Step<'_>, tallies: &[((BodyId, BodyId), Tally)]) {
    let contact = step.ledger.account("contact", AccountKind::Stored);
    let damping = step.ledger.account("contact_damping", AccountKind::Dissipated);
    let friction = step.ledger.account("friction", AccountKind::Dissipated);
    let bodies = || tallies.iter().flat_map(|((a, b), tally)| [(*a, tally), (*b, tally)]);
    for (body, _) in bodies() {
        let stored = bodies().filter(|(other, _)| *other == body).map(|(_, tally)| 0.5 * tally.stored).sum();
        step.ledger.set(contact, body, stored);
    }
    for (body, tally) in bodies() {
        step.ledger.add(damping, body, 0.5 * tally.losses.damping);
        step.ledger.add(friction, body, 0.5 * tally.losses.friction);
        if tally.removed != 0.0 {
            let removed = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
            step.ledger.add(removed, body, 0.5 * tally.removed);
        }
    }
}
