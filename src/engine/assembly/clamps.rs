//! Clamps of bodies whose kernels live in the current configuration: they must be as thick as the support radius.
//!
//! The support of a particle in front of a thinner clamp reaches into the empty space behind it, as at a free surface, and the clamp is too soft.

use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::notation::quantity;
use crate::plugin::{BodyKind, BodyPlan, Offer, Registry, SimBuilder};
use crate::scene::{Edge, Scene};

/// Warns of every body that is held along all axes and nowhere thick enough.
pub(super) fn warn(scene: &Scene, registry: &Registry, sim: &mut SimBuilder<'_>) {
    let mut held: Vec<Vec<bool>> = sim.bodies.iter().map(|body| vec![false; body.sites.len()]).collect();
    let sides_are_placed = sim.bodies.iter().all(|body| body.kind != BodyKind::Fluid);
    for item in &scene.conditions {
        registry.support(item, |support| {
            let all = support.axes[..scene.dimension.count()].iter().all(|axis| *axis);
            // A layer that stands on its side needs nothing behind it.
            let is_side = support.on.face.is_some() && support.edge == Edge::Stated;
            // A fault of a selection is reported where the condition is built.
            let Ok(selection) = sim.select_at_start(support.on, "on") else { return };
            for (id, rows) in selection.parts.iter().filter(|_| all && !(is_side && sides_are_placed)) {
                let first = sim.bodies[id.0].rows.start;
                rows.iter().for_each(|row| held[id.0][*row as usize - first] = true);
            }
        });
    }
    let thin = sim.bodies.iter().zip(&held).filter_map(|(body, held)| of_body(body, held, sides_are_placed));
    thin.collect::<Vec<_>>().into_iter().for_each(|warning| sim.warn(warning));
}

fn of_body(body: &BodyPlan, held: &[bool], sides_are_placed: bool) -> Option<String> {
    let reach = body.support.filter(|_| body.offers(Offer::PairControl))?;
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
    is_thin.then(|| {
        // Beside a fluid a side that is held stays in its lattice.
        let or_side = if sides_are_placed { ", or hold its side by `face`" } else { "" };
        format!(
            "body `{}` is clamped over less than its kernel support, which makes the clamp soft: clamp at least {} of it{or_side}",
            body.name,
            quantity((reach / body.spacing).ceil() * body.spacing, "m")
        )
    })
}
