//! Clamps of Eulerian bodies must be as thick as the support radius.
//!
//! The support of a particle in front of a thinner clamp reaches into the empty space behind it, as at a free
//! surface: the clamp acts up to half a spacing from its stated edge. Deflections, forces and
//! plastic strains differ by up to 4 % from those of a thick one.

use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::notation::quantity;
use crate::plugin::{BodyKind, BodyPlan, Distances, Registry, SimBuilder};
use crate::scene::{Edge, Scene};

/// Warns of every body that is held and nowhere thick enough: along all axes, or by `Fix` within a shape
/// along some.
pub(super) fn warn(scene: &Scene, registry: &Registry, sim: &mut SimBuilder<'_>) {
    let none = || -> Vec<Vec<bool>> { sim.bodies.iter().map(|body| vec![false; body.sites.len()]).collect() };
    let (mut held, mut partly) = (none(), none());
    let sides_are_placed = sim.bodies.iter().all(|body| body.kind != BodyKind::Fluid);
    for item in &scene.conditions {
        registry.support(item, |support| {
            let all = support.axes[..scene.dimension.count()].iter().all(|axis| *axis);
            // A layer that stands on its side, or on a part of it, needs nothing behind it.
            let is_side = sides_are_placed && support.on.face.is_some() && support.edge == Edge::Stated;
            let is_part = !all && !is_side && item.name() == "Fix" && support.on.within.is_some();
            let is_part = is_part && support.on.nearest.is_none() && support.edge == Edge::Stated;
            // A fault of a selection is reported where the condition is built.
            let Ok(selection) = sim.select_at_start(support.on, "on") else { return };
            let marks = if is_part { &mut partly } else { &mut held };
            for (id, rows) in selection.parts.iter().filter(|_| is_part || all && !is_side) {
                let first = sim.bodies[id.0].rows.start;
                rows.iter().for_each(|row| marks[id.0][*row as usize - first] = true);
            }
        });
    }
    let mut thin = Vec::new();
    for ((body, held), partly) in sim.bodies.iter().zip(&held).zip(&partly) {
        thin.extend(thin_support(body, held).map(|reach| of_clamp(body, reach, sides_are_placed)));
        thin.extend(thin_support(body, partly).map(|reach| of_part(body, reach, sides_are_placed)));
    }
    thin.into_iter().for_each(|warning| sim.warn(warning));
}

/// The kernel support of a body whose particles are held nowhere as thick as it, m.
fn thin_support(body: &BodyPlan, held: &[bool]) -> Option<f64> {
    let reach = body.support.filter(|_| body.distances != Distances::Reference)?;
    let of = |is_held: bool| -> Vec<_> {
        let own = body.sites.iter().zip(held).filter(|(_, held)| **held == is_held);
        own.map(|(site, _)| site.position).collect()
    };
    let (inside, outside) = (of(true), of(false));
    if inside.is_empty() || outside.is_empty() {
        return None;
    }
    let mut list = NeighborList::default();
    let (targets, sources) = (Cloud::uniform(&inside, reach), Cloud::uniform(&outside, reach));
    NeighborSearch::default().between(targets, sources, 0.0, &Periodic::NONE, &mut list).ok()?;
    let is_thin = (0..inside.len()).all(|row| !list.row(row).is_empty());
    is_thin.then_some(reach)
}

fn of_clamp(body: &BodyPlan, reach: f64, sides_are_placed: bool) -> String {
    let (thickness, or_side) = (min_thickness(body, reach), or_side(sides_are_placed));
    format!(
        "body `{}` is clamped over less than its kernel support: it is held up to {} from the edge of the clamp; clamp at least {thickness} of it{or_side}",
        body.name,
        quantity(0.5 * body.spacing, "m")
    )
}

fn of_part(body: &BodyPlan, reach: f64, sides_are_placed: bool) -> String {
    let (thickness, or_side) = (min_thickness(body, reach), or_side(sides_are_placed));
    format!(
        "body `{}` is held within a shape along some axes, over less than its kernel support: the support ends up to {} before the edge of the shape; hold at least {thickness} of it{or_side}",
        body.name,
        quantity(0.5 * body.spacing, "m")
    )
}

/// The thickness of a support that the kernel does not see through, m, as text.
fn min_thickness(body: &BodyPlan, reach: f64) -> String {
    quantity((reach / body.spacing).ceil() * body.spacing, "m")
}

/// Beside a fluid a side that is held stays in its lattice.
fn or_side(sides_are_placed: bool) -> &'static str {
    if sides_are_placed { ", or hold its side by `face`" } else { "" }
}
