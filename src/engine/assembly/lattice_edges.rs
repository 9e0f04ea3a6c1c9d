//! Supports that end in the lattice, and not where a scene states it.

use crate::notation::quantity;
use crate::plugin::{BodyKind, BodyPlan, Offer, Registry, SimBuilder};
use crate::scene::{Edge, Scene};
use crate::world::BodyId;

/// Distance over the length of the body from which on it is worth a word.
const NOTABLE: f64 = 0.01;
/// How far inside of a side the support acts, over the spacing, where particles stay in their lattice:
/// measured on strips of 16 and 32 spacings, whose outermost layers hardly strain.
const OF_SIDE: f64 = 1.0;
/// The same in a lattice beside a fluid, whose particles are the surface of the body, and of particles from a
/// file, whose surface is not known: half a spacing.
const OF_LATTICE_SIDE: f64 = 0.5;
/// How far before the edge of a shape it ends.
const OF_PART: f64 = 0.5;

/// Warns of every body that `Fix` holds within a shape along some axes only, and of those that it holds by a
/// side where the formulation, a fluid or a file leaves particles in place. Where kernels follow the present
/// configuration, a part that is held as deep as they reach ends where its shape does: 0.3 % too soft on a
/// strip of 25 spacings.
pub(super) fn warn(scene: &Scene, registry: &Registry, sim: &mut SimBuilder<'_>) {
    let mut warnings = Vec::new();
    let is_wet = sim.bodies().iter().any(|body| body.kind == BodyKind::Fluid);
    for item in scene.conditions.iter().filter(|item| item.name() == "Fix") {
        registry.support(item, |support| {
            // A fault of a selection is reported where the condition is built.
            let Ok(selection) = sim.select_at_start(support.on, "on") else { return };
            if support.edge != Edge::Stated || support.on.nearest.is_some() {
                return;
            }
            let some = !support.axes[..scene.dimension.count()].iter().all(|axis| *axis);
            for (id, rows) in &selection.parts {
                let body = sim.body(*id);
                if body.kind != BodyKind::Solid || rows.len() == body.sites.len() {
                    continue;
                }
                warnings.extend(match support.on.face {
                    Some(face) if !body.offers(Offer::Sides) => of_side(body, face.outward().0),
                    Some(face) if is_wet => of_wet_side(body, face.outward().0),
                    Some(face) if !has_surface(scene, *id, sim) => of_file_side(body, face.outward().0),
                    None if some && support.on.within.is_some() && body.offers(Offer::Supports) => {
                        of_part(body)
                    }
                    _ => None,
                });
            }
        });
    }
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}

/// Whether the shape of a body has a surface; particles from a file have none.
fn has_surface(scene: &Scene, id: BodyId, sim: &SimBuilder<'_>) -> bool {
    scene.bodies[id.0].shape.region(scene.dimension, sim.folder(), "shape").is_ok()
}

/// A distance as text, with its share of a length in percent, if that is notable.
fn share(way: f64, length: f64) -> Option<(String, f64)> {
    (way > NOTABLE * length).then(|| (quantity(way, "m"), 100.0 * way / length))
}

fn of_side(body: &BodyPlan, axis: usize) -> Option<String> {
    let (way, percent) = share(OF_SIDE * body.spacing, body.bounds.extent()[axis])?;
    Some(format!(
        "body `{}` moves by `{}`, which holds a side by its outermost particles: the support acts up to {way} inside of it, and the body is up to {percent:.0} % stiffer for each side; use `TotalLagrangian`, or a smaller spacing",
        body.name, body.formulation
    ))
}

fn of_wet_side(body: &BodyPlan, axis: usize) -> Option<String> {
    let (way, percent) = share(OF_LATTICE_SIDE * body.spacing, body.bounds.extent()[axis])?;
    Some(format!(
        "body `{}` is held by a side in a scene with fluids, where its particles stay in their lattice: the support acts {way} inside of it, and the body is {percent:.1} % stiffer for each side, three times that in bending; let the body go on behind the side for a support radius of its kernel and hold that part by `within`, or use a smaller spacing",
        body.name
    ))
}

fn of_file_side(body: &BodyPlan, axis: usize) -> Option<String> {
    let (way, percent) = share(OF_LATTICE_SIDE * body.spacing, body.bounds.extent()[axis])?;
    Some(format!(
        "body `{}` is held by a side, and its particles are from a file, which states no surface: the support acts at the outermost of them, {way} inside of the side that they stand for, and the body is {percent:.1} % stiffer for each side, three times that in bending; let the particles go on behind the side for a support radius of its kernel and hold that part by `within`, or use a smaller spacing",
        body.name
    ))
}

fn of_part(body: &BodyPlan) -> Option<String> {
    let (way, percent) = share(OF_PART * body.spacing, body.bounds.extent().max_element())?;
    Some(format!(
        "body `{}` is held within a shape along some axes only: that support ends up to {way} before the edge of the shape, and the body is up to {percent:.0} % softer; let the body end there and hold its side by `face`, hold all axes, or use a smaller spacing",
        body.name
    ))
}
