//! Which particles of a wall are at convex edges of its shape.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::formulations::fluid::cloud::FlowCloud;
use crate::formulations::fluid::walls::surface_distance::BoundaryShape;
use crate::world::ReferencePosition;

/// Radius of the sphere that is looked at around a particle, over the spacing.
const RADIUS: f64 = 1.2;
/// Points on it, in the plane and in space.
const POINTS: [usize; 2] = [64, 256];
/// Part of it that is outside of the shape above which there is an edge, in the plane and in space: half a
/// spacing below a flat face it is 0.36 and 0.29, at a right angle 0.6 and 0.5.
const OUTSIDE: [f64; 2] = [0.45, 0.36];
/// Depth of the particles that are looked at, over the spacing.
const DEPTH: f64 = 1.0;

/// Adds the rows, in the cloud, of the particles of a wall at convex edges; `reference` are the places of its
/// particles in the scene.
pub fn add_edges(
    shape: &BoundaryShape,
    cloud: &FlowCloud,
    reference: &[ReferencePosition],
    out: &mut Vec<usize>,
) {
    let points = sphere(cloud.plane);
    let limit = OUTSIDE[usize::from(!cloud.plane)] * points.len() as f64;
    let is_edge = |at: DVec3| {
        let depth = -shape.distance(cloud, at);
        if !(0.0..DEPTH * shape.spacing).contains(&depth) {
            return false;
        }
        // As from the first row of a lattice, wherever the particle is.
        let out = shape.gradient(cloud, at).normalize_or_zero();
        let from = at + (depth - 0.5 * shape.spacing) * out;
        let is_outside = |unit: &&DVec3| shape.distance(cloud, from + RADIUS * shape.spacing * **unit) > 0.0;
        points.iter().filter(is_outside).count() as f64 > limit
    };
    let at_edges = reference.iter().enumerate().filter(|(_, place)| is_edge(place.0));
    out.extend(at_edges.map(|(k, _)| shape.group.cloud.start + k));
}

/// Unit vectors in all directions, evenly: on a circle, or on a spiral around a sphere.
fn sphere(plane: bool) -> Vec<DVec3> {
    let count = POINTS[usize::from(!plane)];
    let golden = TAU * 0.618_033_988_749_895;
    let place = |k: usize| {
        let part = (k as f64 + 0.5) / count as f64;
        let z = if plane { 0.0 } else { 1.0 - 2.0 * part };
        let angle = if plane { TAU * part } else { golden * k as f64 };
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
    };
    (0..count).map(place).collect()
}
