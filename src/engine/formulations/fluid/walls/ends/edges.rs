//! Which particles of a wall are at convex edges of its shape.

use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;

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

/// Adds the rows, in the cloud, of the particles of a wall at convex edges, which `points` around them tell;
/// `reference` are the places of its particles in the scene.
pub fn add_edges(
    shape: &BoundaryShape,
    cloud: &FlowCloud,
    points: &SpherePoints,
    reference: &[ReferencePosition],
    out: &mut Vec<usize>,
) {
    let limit = OUTSIDE[usize::from(!cloud.plane)];
    let seen = SeenShape {
        distance: |at| shape.distance(cloud, at),
        bound: |at| shape.distance_bound(cloud, at),
        gradient: |at| shape.gradient(cloud, at),
        spacing: shape.spacing,
    };
    let at_edges = reference.par_iter().enumerate().filter(|(_, place)| seen.is_edge(place.0, points, limit));
    out.par_extend(at_edges.map(|(k, _)| shape.group.cloud.start + k));
}

/// A shape by its distance, m, and a bound of that with its sign, with the spacing of its particles, m.
struct SeenShape<D, B, G> {
    distance: D,
    bound: B,
    gradient: G,
    spacing: f64,
}

impl<D: Fn(DVec3) -> f64, B: Fn(DVec3) -> f64, G: Fn(DVec3) -> DVec3> SeenShape<D, B, G> {
    /// Whether more than a part `limit` of the sphere around a particle near the surface is outside of the
    /// shape.
    fn is_edge(&self, at: DVec3, points: &SpherePoints, limit: f64) -> bool {
        let depth = -(self.distance)(at);
        if !(0.0..DEPTH * self.spacing).contains(&depth) {
            return false;
        }
        // As from the first row of a lattice, wherever the particle is.
        let out = (self.gradient)(at).normalize_or_zero();
        let from = at + (depth - 0.5 * self.spacing) * out;
        let radius = RADIUS * self.spacing;
        points.is_open(radius, -out, limit, |unit| (self.bound)(from + radius * unit))
    }
}

/// Points in all directions, evenly: on a circle, or on a spiral around a sphere.
pub struct SpherePoints {
    units: Vec<DVec3>,
    /// The others around each point, by their distances from it on the unit sphere.
    around: Vec<Vec<(f64, usize)>>,
}

impl SpherePoints {
    /// Those of the plane, or of space.
    pub fn new(plane: bool) -> Self {
        let count = POINTS[usize::from(!plane)];
        let golden = TAU * 0.618_033_988_749_895;
        let place = |k: usize| {
            let part = (k as f64 + 0.5) / count as f64;
            let z = if plane { 0.0 } else { 1.0 - 2.0 * part };
            let angle = if plane { TAU * part } else { golden * k as f64 };
            let radius = (1.0 - z * z).sqrt();
            DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        let units: Vec<DVec3> = (0..count).map(place).collect();
        let around = |own: &DVec3| {
            let mut around: Vec<(f64, usize)> =
                units.iter().enumerate().map(|(k, unit)| (own.distance(*unit), k)).collect();
            around.sort_by(|a, b| a.0.total_cmp(&b.0));
            around
        };
        let around = units.iter().map(around).collect();
        Self { units, around }
    }

    /// Whether more than a part `limit` of the points on a sphere of that radius are outside of a shape;
    /// `bound` has the sign of the distance from it and is no larger, so that all points that are nearer than
    /// it are on the same side. They are looked at from the one farthest `inward` on, beside which most of
    /// them are within such a distance.
    fn is_open(&self, radius: f64, inward: DVec3, limit: f64, bound: impl Fn(DVec3) -> f64) -> bool {
        let count = self.units.len();
        let begin = (1..count).fold(0, |begin, k| {
            if self.units[k].dot(inward) > self.units[begin].dot(inward) { k } else { begin }
        });
        let mut is_known = [false; POINTS[1]];
        let [mut outside, mut inside] = [0; 2];
        for &(_, k) in &self.around[begin] {
            if is_known[k] {
                continue;
            }
            let bound = bound(self.units[k]);
            let side = if bound > 0.0 { &mut outside } else { &mut inside };
            *side += 1;
            is_known[k] = true;
            for &(_, other) in self.around[k].iter().take_while(|(way, _)| radius * way < bound.abs()) {
                *side += usize::from(!is_known[other]);
                is_known[other] = true;
            }
            let part = |points: usize| points as f64 / count as f64;
            if part(outside) > limit || part(count - inside) <= limit {
                break;
            }
        }
        outside as f64 / count as f64 > limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formulations::fluid::tests::{column, simulation};

    /// Lattices of walls, and the name of each.
    const LATTICES: [&str; 4] =
        ["Regular", "Hexagonal", "BodyFitted(iterations: 10)", "Relaxed(seed: 1, iterations: 30)"];

    /// An edge at the origin of that angle, along z: its faces are behind it, one below y = 0.
    fn edge(
        angle: f64,
        spacing: f64,
    ) -> SeenShape<impl Fn(DVec3) -> f64, impl Fn(DVec3) -> f64, impl Fn(DVec3) -> DVec3> {
        let normals = [DVec3::Y, DVec3::new(angle.sin(), -angle.cos(), 0.0)];
        let distance =
            move |at: DVec3| normals.map(|normal| normal.dot(at)).into_iter().fold(f64::MIN, f64::max);
        let gradient = move |at: DVec3| {
            if normals[0].dot(at) > normals[1].dot(at) { normals[0] } else { normals[1] }
        };
        SeenShape { distance, bound: distance, gradient, spacing }
    }

    /// The particles of a wall of that angle.
    fn particles(lattice: &str, angle: f64, spacing: f64, plane: bool) -> Vec<DVec3> {
        let corner = |turn: f64| format!("({}, {})", -turn.cos(), -turn.sin());
        let polygon = format!("[(0, 0), {}, {}, {}]", corner(0.0), corner(0.5 * angle), corner(angle));
        let shape = if plane {
            format!("Polygon(points: {polygon})")
        } else {
            format!("Extrusion(polygon: {polygon}, from: -0.5, to: 0.5)")
        };
        let (name, drop) = if plane {
            ("Two", "Box(min: (4, 4), max: (4.5, 4.5))")
        } else {
            ("Three", "Box(min: (4, 4, 4), max: (4.5, 4.5, 4.5))")
        };
        let sim = simulation(&format!(
            r#"(dimension: {name}, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                bodies: [
                    (name: "water", material: "water", spacing: {spacing}, formulation: Fluid, shape: {drop}),
                    (name: "wall", material: "wall", spacing: {spacing}, formulation: Wall(slip: Free), lattice: {lattice}, shape: {shape}),
                ], time: (end: 1.0))"#
        ));
        column::<ReferencePosition>(&sim, 1).into_iter().map(|place| place.0).collect()
    }

    /// Whether any particle near the edge counts as one of it.
    fn is_seen(lattice: &str, degrees: f64, spacing: f64, plane: bool) -> bool {
        let (angle, points) = (degrees.to_radians(), SpherePoints::new(plane));
        let shape = edge(angle, spacing);
        // In space away from the ends of the edge.
        let is_near = |at: &DVec3| at.z.abs() < 0.25 && at.truncate().length() < 5.0 * spacing;
        let mut near = particles(lattice, angle, spacing, plane).into_iter().filter(is_near);
        near.any(|at| shape.is_edge(at, &points, OUTSIDE[usize::from(!plane)]))
    }

    /// However the rows of a lattice lie to an edge: its place among them changes with the spacing.
    #[test]
    fn edges_of_up_to_120_degrees_count_in_all_lattices_and_from_155_on_in_none() {
        for lattice in LATTICES {
            for spacing in [0.05, 0.0443, 0.0385] {
                for degrees in [60.0, 90.0, 105.0, 120.0] {
                    assert!(is_seen(lattice, degrees, spacing, true), "{lattice} {spacing}: {degrees}");
                }
                for degrees in [155.0, 170.0] {
                    assert!(!is_seen(lattice, degrees, spacing, true), "{lattice} {spacing}: {degrees}");
                }
            }
        }
        for lattice in &LATTICES[..2] {
            let seen = [75.0, 90.0, 120.0, 155.0].map(|degrees| is_seen(lattice, degrees, 0.1, false));
            assert_eq!(seen, [true, true, true, false], "{lattice} in space");
        }
    }

    /// Points that are not looked at, because one beside them is far from the surface, count as they are.
    #[test]
    fn a_sphere_is_open_if_enough_of_all_points_are_outside() {
        for plane in [true, false] {
            let points = SpherePoints::new(plane);
            for (x, y, z) in
                [(0.1, 0.4, 0.2), (-0.5, 0.7, 0.0), (0.3, -0.2, 0.6), (1.5, 0.1, 0.1), (-3.0, -3.0, -3.0)]
            {
                // A corner, from which the distance is underestimated outside.
                let bound = |unit: DVec3| (1.2 * unit - DVec3::new(x, y, z)).max_element();
                let all = points.units.iter().filter(|unit| bound(**unit) > 0.0).count();
                for count in [0, all.saturating_sub(1), all, all + 1] {
                    let limit = count as f64 / points.units.len() as f64;
                    let is_open = points.is_open(1.2, DVec3::new(x, y, z).normalize(), limit, bound);
                    assert_eq!(is_open, all > count, "{x} {y} {z}: {count} of {all}");
                }
            }
        }
    }

    /// Round walls have no edges.
    #[test]
    fn round_walls_count_as_edges_only_where_they_are_as_thin_as_the_support() {
        for (plane, thin, thick) in [(true, 1.5, 2.5), (false, 3.0, 5.0)] {
            let points = SpherePoints::new(plane);
            let is_seen = |radius: f64| {
                let distance = |at: DVec3| at.length() - radius;
                let ball = SeenShape { distance, bound: distance, gradient: |at| at, spacing: 1.0 };
                ball.is_edge((radius - 0.5) * DVec3::X, &points, OUTSIDE[usize::from(!plane)])
            };
            assert!(is_seen(thin) && !is_seen(thick), "{plane}");
        }
    }
}
