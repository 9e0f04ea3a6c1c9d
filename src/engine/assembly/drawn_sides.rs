//! Metal whose side a condition holds or drives along its normal alone: the layers beside it yield first.

use std::collections::BTreeMap;

use crate::plugin::{BodyKind, Registry, SimBuilder};
use crate::scene::{Face, Scene};
use crate::world::BodyId;

/// Warns of every body with plastic flow that has such a side.
pub(super) fn warn(scene: &Scene, registry: &Registry, sim: &mut SimBuilder<'_>) {
    let mut sides: BTreeMap<BodyId, Face> = BTreeMap::new();
    for item in &scene.conditions {
        registry.support(item, |support| {
            let Some(face) = support.on.face else { return };
            let is_clamped = support.axes[..scene.dimension.count()].iter().all(|axis| *axis);
            // What is wrong with a selection is told where the condition is built.
            let Ok(selection) = sim.select_at_start(support.on, "on") else { return };
            for (id, rows) in selection.parts.iter().filter(|_| support.axes[face.outward().0] && !is_clamped)
            {
                let body = sim.body(*id);
                let flows = || {
                    body.solid_law().is_ok_and(|law| law.initial_yield_stress().is_some_and(f64::is_finite))
                };
                if body.kind == BodyKind::Solid && rows.len() < body.sites.len() && flows() {
                    sides.entry(*id).or_insert(face);
                }
            }
        });
    }
    for (id, face) in sides {
        let name = &sim.body(id).name;
        let warning = format!(
            "the side `{face:?}` of body `{name}` is held or drawn along its normal alone, and the metal beside it yields first: plastic strain within some three spacings is 1.1 to 2.5 times the mean, and that in the middle down to a fifth of it, the more so the less the metal hardens and the fewer particles lie across. `Symmetry` holds a side at rest without that; else give the body thicker ends, and let failure begin away from them"
        );
        sim.warn(warning);
    }
}
