//! Particles held by a side of a body stand on that side.
//!
//! The outermost layer of a lattice is half a spacing inside, which would shorten the body by that much. It is moved onto the side with its mass and volume: the next layer is then one and a half
//! spacings away, and the cells of both fill the body between them. Particles keep their lattice where the side is not a plane, beside symmetry planes and periodic sides, and in scenes with fluids, for which
//! the particles of a body are its surface.

use glam::DVec3;

use crate::boundaries::Symmetry;
use crate::plugin::{BodyKind, Offer, Plugin, Registry, SimBuilder};
use crate::scene::{Edge, Face, Scene};
use crate::shapes::{Aabb, Region};

/// How far the surface of a body may be from its side, over the spacing.
const ON_SIDE: f64 = 1e-3;
/// Share of the way to the side: the particle stays inside of the body.
const INSIDE: f64 = 1.0 - 1e-4;

/// Puts the particles of all conditions that hold a face on it.
pub(super) fn place(scene: &Scene, registry: &Registry, sim: &mut SimBuilder<'_>) {
    if sim.bodies.iter().any(|body| body.kind == BodyKind::Fluid) {
        return;
    }
    let mut ways: Vec<Vec<DVec3>> =
        sim.bodies.iter().map(|body| vec![DVec3::ZERO; body.sites.len()]).collect();
    for item in &scene.conditions {
        registry.support(item, |support| {
            let (Some(face), Edge::Stated, None) = (support.on.face, support.edge, &support.on.nearest)
            else {
                return;
            };
            // What is wrong with a selection is told where the condition is built.
            let Ok(selection) = sim.select_at_start(support.on, "on") else { return };
            for (id, rows) in &selection.parts {
                let body = &sim.bodies[id.0];
                let shape = &scene.bodies[id.0].shape;
                let region = shape.region(scene.dimension, sim.folder, "shape");
                let at = side_of(face, &body.bounds);
                let (Ok(region), false) = (region, is_mirrored(scene, face, at, body.spacing)) else {
                    continue;
                };
                if !body.offers(Offer::Sides) || rows.len() == body.sites.len() {
                    continue;
                }
                for number in rows.iter().map(|row| *row as usize - body.rows.start) {
                    ways[id.0][number] +=
                        way_to_side(body.sites[number].position, face, at, body.spacing, &*region);
                }
            }
        });
    }
    for (body, ways) in sim.bodies.iter_mut().zip(&ways) {
        body.sites.iter_mut().zip(ways).for_each(|(site, way)| site.position += INSIDE * *way);
    }
}

/// Coordinate of a side of a box, m.
fn side_of(face: Face, bounds: &Aabb) -> f64 {
    let (axis, sign) = face.outward();
    if sign < 0.0 { bounds.min[axis] } else { bounds.max[axis] }
}

/// Whether the body goes on behind a side.
fn is_mirrored(scene: &Scene, face: Face, at: f64, spacing: f64) -> bool {
    let axis = face.outward().0;
    let mut planes = scene
        .conditions
        .iter()
        .filter(|item| item.name() == Symmetry::NAME)
        .filter_map(|item| item.parse::<Symmetry>().ok());
    let is_periodic =
        scene.domain.as_ref().is_some_and(|domain| domain.periodic.iter().any(|other| other.index() == axis));
    is_periodic || planes.any(|symmetry| symmetry.plane.index() == axis && (symmetry.at - at).abs() < spacing)
}

/// From a particle to the side of its body, m; none where the side is not its surface.
fn way_to_side(x: DVec3, face: Face, at: f64, spacing: f64, region: &dyn Region) -> DVec3 {
    let axis = face.outward().0;
    let way = DVec3::AXES[axis] * (at - x[axis]);
    if way.length() < spacing && region.distance(x + way).abs() < ON_SIDE * spacing {
        way
    } else {
        DVec3::ZERO
    }
}
