//! Warning of metal beside a side held or driven along its normal alone, where a uniform stress is not in
//! equilibrium: some layers yield first.

use std::collections::BTreeMap;

use crate::plugin::{BodyKind, BodyPlan, Offer, Registry, SimBuilder};
use crate::scene::{Face, Scene};
use crate::world::BodyId;

/// Warns of every body with plastic flow that has such a side.
pub(super) fn warn(scene: &Scene, registry: &Registry, sim: &mut SimBuilder<'_>) {
    let mut sides: BTreeMap<BodyId, Face> = BTreeMap::new();
    for item in &scene.conditions {
        registry.support(item, |support| {
            let Some(face) = support.on.face else { return };
            let is_clamped = support.axes[..scene.dimension.count()].iter().all(|axis| *axis);
            // A fault of a selection is reported where the condition is built.
            let Ok(selection) = sim.select_at_start(support.on, "on") else { return };
            for (id, rows) in selection.parts.iter().filter(|_| support.axes[face.outward().0] && !is_clamped)
            {
                let body = sim.body(*id);
                if body.kind == BodyKind::Solid && rows.len() < body.sites.len() && body.yields() {
                    sides.entry(*id).or_insert(face);
                }
            }
        });
    }
    let warnings: Vec<String> = sides.iter().filter_map(|(id, face)| of_side(sim.body(*id), *face)).collect();
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}

/// Warning of a side, if there is one.
fn of_side(body: &BodyPlan, face: Face) -> Option<String> {
    let name = &body.name;
    let (axis, sign) = face.outward();
    let is_placed = body.sides.iter().any(|side| sign * side.normal[axis] > 0.5);
    let beside = format!("the side `{face:?}` of body `{name}` is held or drawn along its normal alone");
    if is_placed && body.offers(Offer::Supports) {
        return None;
    }
    if is_placed {
        return Some(format!(
            "{beside}; its layers move apart within kernels of the current configuration: plastic strain beside that side is some 5 % off where the body is drawn by 4 %, and 20 % where it is drawn by 20 %; `TotalLagrangian` and `UpdatedLagrangian` bodies strain evenly"
        ));
    }
    Some(format!(
        "{beside} by particles that stay in their lattice, half a spacing inside: the metal beside it hardly yields, and the middle of the body strains by up to twice the mean; leave out `edge: Particles` where the scene has that, or give the body thicker ends"
    ))
}
