//! Held particles stand at the edge that the scene states for the held part of a body.
//!
//! On a lattice the outermost held particles stand a distance d behind that edge, mostly half a spacing a,
//! and the displacement field has its kink there. They are moved to the edge, and the particles held behind
//! them become invisible, as if the body ended there. Every particle carries the share of its stress and
//! energy that its cell has in front of the edge: 1/2 - d/a for a particle that was moved, and at most 3/2 -
//! d/a for the one in front of it. The fit of F is then exact for linear fields up to the edge, and all cells
//! together fill the body in front of it. A bar has the correct stiffness to 0.08 (in shear 0.03) spacings of
//! its length, wherever the edge lies in the lattice.
//!
//! `face` is the same with the side of the body as the edge: d = -a/2, and no particles behind it.

use glam::DVec3;

use super::support_faces;
use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::plugin::{BodyPlan, Offer, Registry, SimBuilder};
use crate::scene::{Edge, Scene};
use crate::shapes::Region;

/// Distance over the spacing up to which a held particle is beside one that is not held: along the diagonal
/// of a square, too.
const BESIDE: f64 = 1.5;
/// Of those that are near, how much farther than the nearest one counts.
const AS_NEAR: f64 = 1.05;
/// How far a particle is moved at most, over the spacing: the next one must not come too near.
const FARTHEST: f64 = 0.75;
/// Share of the distance to the edge: the particle stays inside of the selection, clearly so for shapes with
/// a tolerance.
const INSIDE: f64 = 1.0 - 1e-4;
/// Support radius over spacing of bodies that do not say it.
const USUAL_SUPPORT: f64 = 2.41;
/// Halvings that find where a shape ends.
const HALVINGS: usize = 50;

/// Puts the held particles of all bodies where the conditions of the scene say that they end.
pub(super) fn place(scene: &Scene, registry: &Registry, sim: &mut SimBuilder<'_>) {
    support_faces::place(scene, registry, sim);
    // Of every body, by which shape each particle is held.
    let mut held: Vec<Vec<Option<usize>>> =
        sim.bodies.iter().map(|body| vec![None; body.sites.len()]).collect();
    let mut shapes: Vec<Box<dyn Region>> = Vec::new();
    for item in &scene.conditions {
        registry.support(item, |support| {
            let all = support.axes[..scene.dimension.count()].iter().all(|axis| *axis);
            let (Some(shape), Edge::Stated, true, None, None) =
                (&support.on.within, support.edge, all, support.on.face, &support.on.nearest)
            else {
                return;
            };
            let region = shape.region(scene.dimension, sim.folder, "within");
            // A fault of a selection is reported where the condition is built.
            let (Ok(region), Ok(selection)) = (region, sim.select_at_start(support.on, "on")) else { return };
            for (id, rows) in &selection.parts {
                let first = sim.bodies[id.0].rows.start;
                rows.iter().for_each(|row| held[id.0][*row as usize - first] = Some(shapes.len()));
            }
            shapes.push(region);
        });
    }
    for (body, held) in sim.bodies.iter_mut().zip(&held) {
        let count = held.iter().flatten().count();
        if body.offers(Offer::Supports) && count > 0 && count < held.len() {
            place_body(body, held, &shapes);
        }
    }
}

fn place_body(body: &mut BodyPlan, held: &[Option<usize>], shapes: &[Box<dyn Region>]) {
    let of = |is_held: bool| (0..held.len() as u32).filter(move |k| held[*k as usize].is_some() == is_held);
    let place = |k: u32| body.sites[k as usize].position;
    let (inside, outside): (Vec<u32>, Vec<u32>) = (of(true).collect(), of(false).collect());
    let [targets, sources] = [&inside, &outside].map(|all| all.iter().map(|&k| place(k)).collect::<Vec<_>>());
    let reach = body.support.unwrap_or(USUAL_SUPPORT * body.spacing);
    let mut list = NeighborList::default();
    let cloud = |places| Cloud::uniform(places, reach);
    let found =
        NeighborSearch::default().between(cloud(&targets), cloud(&sources), 0.0, &Periodic::NONE, &mut list);
    if found.is_err() {
        return;
    }
    let (mut moves, mut before) = (Vec::new(), vec![1.0_f64; body.sites.len()]);
    for (row, &k) in inside.iter().enumerate() {
        let others = || list.row(row).iter().map(|&other| (outside[other as usize], sources[other as usize]));
        let nearest = others().map(|other| other.1.distance(targets[row])).fold(f64::INFINITY, f64::min);
        if nearest > BESIDE * body.spacing {
            body.hidden.push(k);
            continue;
        }
        let region = &*shapes[held[k as usize].unwrap_or_default()];
        let places = others().map(|other| other.1);
        let way = vector_to_edge(targets[row], places, nearest, region)
            .map(|way| way.clamp_length_max(FARTHEST * body.spacing));
        let length = way.map_or(1.0, |way| way.length() / body.spacing);
        body.carried.push((k, (0.5 - length).max(0.0)));
        if let Some(way) = way {
            moves.push((k, way));
            let in_front = others().filter(|other| other.1.distance(targets[row]) < AS_NEAR * nearest);
            in_front.for_each(|(other, _)| before[other as usize] = before[other as usize].min(1.5 - length));
        }
    }
    body.carried.extend(outside.iter().map(|&k| (k, before[k as usize])).filter(|(_, share)| *share < 1.0));
    for (k, way) in moves {
        body.sites[k as usize].position += INSIDE * way;
    }
}

/// Vector from a held particle to the edge of the held part, m; none if it has no direction. The nearest of
/// the others is so far away, m.
///
/// The edge is the plane through the places where the ways to the nearest of the others leave the shape.
fn vector_to_edge(
    x: DVec3,
    others: impl Iterator<Item = DVec3> + Clone,
    nearest: f64,
    region: &dyn Region,
) -> Option<DVec3> {
    let near = others.filter(|other| other.distance(x) < AS_NEAR * nearest);
    // n/|n|^2 with n = sum e_k/a_k is the foot of x on the plane through x + a_k e_k, for directions e_k at
    // right angles.
    let normal: DVec3 = near.map(|other| (other - x).normalize() / distance_to_edge(x, other, region)).sum();
    let way = normal / normal.length_squared();
    (way.is_finite() && way.length() < nearest).then_some(way)
}

/// How far from x, inside of a region, towards a place outside of it the region ends, m.
fn distance_to_edge(x: DVec3, outside: DVec3, region: &dyn Region) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if region.contains(x.lerp(outside, middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    (high * x.distance(outside)).max(1e-9 * x.distance(outside))
}
