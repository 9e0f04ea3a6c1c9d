//! Loads on a face beside a side that is held along its normal alone.
//!
//! The particles of such a side stand on it, and the load of their cells acts at arms of half a spacing. These bend the layers beside the edge as long as nothing takes the moment, which the other half of the body does behind a symmetry plane.

use crate::boundaries::{PressureLoad, Traction};
use crate::notation::number;
use crate::plugin::{BodyKind, Plugin, SimBuilder};
use crate::scene::{Item, Scene, Select};

/// Warns of every such load.
pub(super) fn warn(scene: &Scene, sim: &mut SimBuilder<'_>) {
    let texts: Vec<String> = scene.conditions.iter().filter_map(|item| of_load(item, sim)).collect();
    texts.into_iter().for_each(|text| sim.warn(text));
}

fn of_load(item: &Item, sim: &SimBuilder<'_>) -> Option<String> {
    let on: Select = match item.name() {
        Traction::NAME => item.parse::<Traction>().ok()?.on,
        PressureLoad::NAME => item.parse::<PressureLoad>().ok()?.on,
        _ => return None,
    };
    let face = on.face?;
    // A fault of a selection is reported where the condition is built.
    let selection = sim.select_at_start(&on, "on").ok()?;
    let (axis, _) = face.outward();
    selection.parts.iter().find_map(|(id, rows)| {
        let body = sim.body(*id);
        let first = body.rows.start as u32;
        let is_loaded = |number: &u32| rows.binary_search(&(first + number)).is_ok();
        let meets = |side: &&crate::plugin::HeldSide| {
            side.plane.0 != axis && side.moved.iter().any(|(number, _)| is_loaded(number))
        };
        let side = body.sides.iter().find(meets).filter(|_| body.kind == BodyKind::Solid)?;
        let (of_side, at) = side.plane;
        let name = ["X", "Y", "Z"][of_side];
        Some(format!(
            "`{}` on `{face:?}` of body `{}` reaches its side at {} = {} m, which is held along its normal alone: stresses in the two particles beside that edge are some 20 % off, however fine they are; `Symmetry(plane: {name}, at: {})` in the place of that support has 1 %",
            item.name(),
            body.name,
            name.to_lowercase(),
            number(at),
            number(at)
        ))
    })
}
