//! Contact laws in the registry.

use super::law::{ContactLaw, ContactPair, NormalForce};
use crate::plugin::{EntryKind, Registry, SetupError};
use crate::scene::{Item, Problem};

type BuildContactLaw = fn(&Item, &ContactPair) -> Result<Box<dyn NormalForce>, Vec<Problem>>;

impl Registry {
    /// Registers a contact law.
    pub fn contact_law<L: ContactLaw>(&mut self) -> &mut Self {
        let build: BuildContactLaw = |item, pair| {
            let law: L = item.parse()?;
            law.build(pair).map_err(|error| SetupError::from(error).into_problems(item))
        };
        self.add_builder::<L, _>(EntryKind::ContactLaw, L::NAME, L::REFERENCE, build)
    }

    pub(crate) fn build_contact_law(
        &self,
        item: &Item,
        pair: &ContactPair,
    ) -> Result<Box<dyn NormalForce>, Vec<Problem>> {
        self.builder::<BuildContactLaw>(EntryKind::ContactLaw, item)?(item, pair)
    }
}
