//! Pair terms as plugins hand them in.

use super::bound::ErasedTerm;
use super::term::PairTerm;
use crate::plugin::SimBuilder;
use crate::world::BodySet;

/// A pair term of a plugin, for bodies, with the account of its work.
pub(crate) struct PairTermOfBodies {
    pub(super) account: String,
    pub(super) term: Box<dyn ErasedTerm>,
}

impl SimBuilder<'_> {
    /// Adds a pair term to bodies. The energy that its forces take out of the motion is booked as dissipated,
    /// in the account of that name; it is negative where they put energy in. A body whose formulation takes
    /// no pair terms is an error of the scene.
    pub fn add_pair_term(&mut self, bodies: BodySet, account: &str, term: impl PairTerm) {
        let term = PairTermOfBodies { account: account.to_owned(), term: Box::new(term) };
        self.extend_bodies(bodies, "a pair term", term);
    }
}
