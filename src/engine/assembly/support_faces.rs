//! Held particles of a `face` are moved onto that side of the body.
//!
//! The outermost layer of a lattice is half a spacing inside, which would shorten the body by that much. It
//! is moved onto the side with its mass and volume: the next layer is then one and a half spacings away, and
//! the cells of both fill the body between them. Particles keep their lattice where the side is not a plane,
//! beside symmetry planes and periodic sides, and in scenes with fluids, for which the particles of a body
//! are its surface. Beside a side that is held along its normal alone, and beside one that is held along all
//! axes where the body is endless along it or yields, the formulations give the particles shares of their
//! stress for which a uniform stress is in equilibrium.

use glam::DVec3;

use crate::boundaries::Symmetry;
use crate::plugin::{BodyKind, BodyPlan, HeldSide, Offer, Plugin, Registry, SideHold, SimBuilder};
use crate::scene::{Edge, Face, Scene};
use crate::shapes::{Aabb, Region};

/// How far the surface of a body may be from its side, over the spacing.
const ON_SIDE: f64 = 1e-3;
/// Share of the way to the side: the particle stays inside of the body.
const INSIDE: f64 = 1.0 - 1e-4;

/// Moves the particles of all conditions that hold a face onto it.
pub(super) fn place(scene: &Scene, registry: &Registry, sim: &mut SimBuilder<'_>) {
    if sim.bodies.iter().any(|body| body.kind == BodyKind::Fluid) {
        return;
    }
    // With the axes along which a condition holds the side.
    let mut sides: Vec<Vec<(HeldSide, [bool; 3])>> = vec![Vec::new(); sim.bodies.len()];
    for item in &scene.conditions {
        registry.support(item, |support| {
            let (Some(face), Edge::Stated, None) = (support.on.face, support.edge, &support.on.nearest)
            else {
                return;
            };
            // A fault of a selection is reported where the condition is built.
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
                let way = |row: &u32| {
                    let number = *row - body.rows.start as u32;
                    let x = body.sites[number as usize].position;
                    (number, INSIDE * vector_to_side(x, face, at, body.spacing, &*region))
                };
                let moved: Vec<_> = rows.iter().map(way).filter(|(_, way)| *way != DVec3::ZERO).collect();
                if moved.is_empty() {
                    continue;
                }
                let (axis, sign) = face.outward();
                let hold = if is_endless(scene, axis, body) { SideHold::Endless } else { SideHold::Drawn };
                let side = HeldSide { normal: sign * DVec3::AXES[axis], plane: (axis, at), moved, hold };
                sides[id.0].push((side, support.axes));
            }
        });
    }
    for (body, sides) in sim.bodies.iter_mut().zip(&sides) {
        place_body(body, sides, scene.dimension.count());
    }
}

/// Moves the particles of a body onto its sides, each with the axes along which a condition holds it.
fn place_body(body: &mut BodyPlan, sides: &[(HeldSide, [bool; 3])], axes: usize) {
    // Several conditions may hold one side, each along some axes: it is one plane all the same.
    let mut ways = vec![DVec3::ZERO; body.sites.len()];
    for (k, way) in sides.iter().flat_map(|(side, _)| &side.moved) {
        let axis = way.abs().max_position();
        ways[*k as usize][axis] = way[axis];
    }
    body.sites.iter_mut().zip(ways).for_each(|(site, way)| site.position += way);
    let is_held = |side: &HeldSide, axis: usize| {
        sides.iter().any(|(other, held)| other.normal == side.normal && held[axis])
    };
    let yields = body.yields();
    // A stress that is uniform up to a side needs a side that can contract, or one without edges. Beside a
    // clamped one it is not, but what yields finds the layer with the smallest force.
    let hold = |side: &HeldSide| {
        let is_clamped = side.hold == SideHold::Drawn && (0..axes).all(|axis| is_held(side, axis));
        if is_clamped { yields.then_some(SideHold::Clamped) } else { Some(side.hold) }
    };
    let balanced = sides.iter().filter(|(side, held)| held[side.plane.0]);
    let balanced = balanced.filter_map(|(side, _)| Some(HeldSide { hold: hold(side)?, ..side.clone() }));
    body.sides.extend(balanced.collect::<Vec<_>>());
}

/// Whether a body continues beyond both of its ends along each axis but this one: sides along this axis have
/// no edges.
fn is_endless(scene: &Scene, across: usize, body: &BodyPlan) -> bool {
    let faces = [(Face::MinX, Face::MaxX), (Face::MinY, Face::MaxY), (Face::MinZ, Face::MaxZ)];
    let mut along = (0..scene.dimension.count()).filter(|axis| *axis != across);
    along.all(|axis| {
        let (low, high) = (body.bounds.min[axis], body.bounds.max[axis]);
        let reaches = |(end, at): (f64, f64)| (end - at).abs() < 0.5 * body.spacing;
        let is_across = scene.domain.as_ref().is_none_or(|domain| {
            let is_periodic = domain.periodic.iter().any(|other| other.index() == axis);
            !is_periodic || (reaches((low, domain.min.0[axis])) && reaches((high, domain.max.0[axis])))
        });
        let continues = |face: Face, at: f64| is_mirrored(scene, face, at, body.spacing);
        is_across && continues(faces[axis].0, low) && continues(faces[axis].1, high)
    })
}

/// Coordinate of a side of a box, m.
fn side_of(face: Face, bounds: &Aabb) -> f64 {
    let (axis, sign) = face.outward();
    if sign < 0.0 { bounds.min[axis] } else { bounds.max[axis] }
}

/// Whether the body continues beyond a side.
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
fn vector_to_side(x: DVec3, face: Face, at: f64, spacing: f64, region: &dyn Region) -> DVec3 {
    let axis = face.outward().0;
    let way = DVec3::AXES[axis] * (at - x[axis]);
    if way.length() < spacing && region.distance(x + way).abs() < ON_SIDE * spacing {
        way
    } else {
        DVec3::ZERO
    }
}
