//! Contact of the skins of two deformable bodies, which has memory for points and facets once they are near.

use std::sync::Arc;

use super::near_skins::NearSkins;
use super::pair::SkinPair;
use crate::contact::response::Interaction;
use crate::neighbors::Periodic;
use crate::skins::Skin;

/// Two skins that may touch.
pub(in crate::contact) struct SkinContact {
    interaction: Arc<Interaction>,
    pub skins: [Arc<Skin>; 2],
    periodic: Periodic,
    near: Option<Box<SkinPair>>,
}

impl SkinContact {
    /// Of two skins, or of one with itself, in a domain that is periodic along some axes.
    pub fn new(interaction: Interaction, skins: [Arc<Skin>; 2], periodic: Periodic) -> Self {
        Self { interaction: Arc::new(interaction), skins, periodic, near: None }
    }

    /// Minimum period of the domain with which the contact works, m.
    pub fn min_period(&self) -> f64 {
        NearSkins::min_period(self.skins.each_ref().map(|skin| &**skin))
    }

    /// The contact, if they have been near each other.
    pub fn known(&self) -> Option<&SkinPair> {
        self.near.as_deref()
    }

    /// The contact, with memory for all that may touch.
    pub fn near(&mut self) -> &mut SkinPair {
        let Self { interaction, skins, periodic, near } = self;
        near.get_or_insert_with(|| {
            Box::new(SkinPair::new(Arc::clone(interaction), skins.each_ref().map(Arc::clone), *periodic))
        })
    }
}
