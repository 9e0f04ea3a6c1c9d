//! Loads on bodies that can fail: on their skins ([`skin_load`](super::skin_load)) for as long as these are
//! whole, on particles from then on.
//!
//! The skin has its last forces in the first kick of the step in which it breaks, and the particles have
//! theirs in the second one, so that the work of both is booked as for other loads.

use glam::DVec3;

use super::load;
use super::load_law::LoadLaw;
use super::part::Part;
use super::skin_load::SkinLoads;
use crate::plugin::{Selection, SetupError, SimBuilder};
use crate::schedule::{Shared, Step, StepError};

/// A load on particles of bodies whose skins are broken.
pub(super) struct BrokenSkinLoad<L> {
    law: L,
    skins: Shared<SkinLoads>,
}

impl<L: LoadLaw> LoadLaw for BrokenSkinLoad<L> {
    fn forces(&self, k: usize, part: &Part, step: &Step<'_>, out: &mut Vec<DVec3>) -> Result<(), StepError> {
        if step.resources.of(self.skins).act_on(part.body) {
            out.clear();
            out.resize(part.rows.len(), DVec3::ZERO);
            return Ok(());
        }
        self.law.forces(k, part, step, out)
    }

    fn is_constant(&self, _: &Part) -> bool {
        false
    }
}

/// Adds the load on particles to those bodies of a selection that can fail: `law` makes it for them.
pub(super) fn apply<L: LoadLaw>(
    label: &'static str,
    skins: Shared<SkinLoads>,
    selection: &Selection,
    sim: &mut SimBuilder<'_>,
    law: impl FnOnce(&Selection, &mut SimBuilder<'_>) -> Result<L, SetupError>,
) -> Result<(), SetupError> {
    let parts = selection.parts.iter().filter(|(id, _)| sim.body(*id).can_fail()).cloned();
    let fragile = Selection { parts: parts.collect() };
    if !fragile.is_empty() {
        let law = BrokenSkinLoad { law: law(&fragile, sim)?, skins };
        load::apply(label, law, &fragile, sim, |system| system.reads::<crate::world::DeformationGradient>());
    }
    Ok(())
}
