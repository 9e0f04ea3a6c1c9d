//! Loads on a `face` beside a side that is held along its normal alone. Loads by `surface` are warned of
//! where they are added, and contact where it reaches such a side.
//!
//! The particles of such a side lie on it, and the load of their cells acts at lever arms of half a spacing.
//! The moment bends the layers beside the edge, because nothing balances it; behind a symmetry plane the
//! other half of the body does.

use crate::boundaries::{PressureLoad, Traction};
use crate::plugin::{BodyKind, HeldSide, Plugin, SimBuilder};
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
        let meets =
            |side: &&HeldSide| side.plane.0 != axis && side.moved.iter().any(|(number, _)| is_loaded(number));
        let what = format!("`{}` on `{face:?}` of body `{}`", item.name(), body.name);
        let sides = body.sides.iter().filter(|_| body.kind == BodyKind::Solid);
        sides.filter(meets).find_map(|side| side.reached_by(&what))
    })
}
