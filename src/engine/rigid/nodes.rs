//! The points with which a rigid body touches others.

use std::collections::BTreeSet;

use glam::DVec3;

use super::inertia::sphere_of;
use crate::shapes::{Shape, Site, Surface};

/// Cosine of the angle between two normals above which two faces do not touch: some 96 degrees.
const ACROSS: f64 = -0.1;

/// The points with which a rigid body touches the surfaces of other rigid bodies.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// Their places in the reference configuration, m.
    pub points: Vec<DVec3>,
    /// Outward normals of the surface there; zero on edges and corners, and for a sphere.
    normals: Vec<DVec3>,
    /// Radius of the sphere about each, m: that of a body that is one sphere, else zero.
    pub radius: f64,
    /// Distance between them, m.
    pub spacing: f64,
}

impl Nodes {
    /// The centre of a sphere or disc. Of other shapes points on sharp edges and corners, and the outermost particles,
    /// moved to the surface.
    pub(super) fn new(shape: &Shape, surface: &dyn Surface, sites: &[Site], spacing: f64) -> Self {
        if let Some((center, radius)) = sphere_of(shape) {
            return Self { points: vec![center], normals: vec![DVec3::ZERO], radius, spacing: 2.0 * radius };
        }
        let mut points = along(&surface.edges(spacing), spacing);
        let mut normals = vec![DVec3::ZERO; points.len()];
        for site in sites {
            let nearest = surface.closest(site.position);
            if nearest.signed_distance.abs() < 0.75 * spacing {
                points.push(nearest.point);
                normals.push(nearest.normal);
            }
        }
        Self { points, normals, radius: 0.0, spacing }
    }

    /// Whether the surface at point `i` may touch one of that outward normal, in the reference configuration: a face does not touch what stands across it. Where the corner of another body passes a
    /// point of a face, the nearest surface of that body is for a moment the side beside the corner.
    pub fn faces(&self, i: usize, normal: DVec3) -> bool {
        self.normals[i] == DVec3::ZERO || self.normals[i].dot(normal) < ACROSS
    }

    /// Radius of the body if it is one sphere, m.
    pub fn sphere(&self) -> Option<f64> {
        (self.radius > 0.0).then_some(self.radius)
    }
}

/// The ends of edges and points between them. Of points in one cell of half a spacing the first is kept, so that the many short edges
/// of a fine mesh make no more of them than a coarse one has; ends come first.
fn along(edges: &[[DVec3; 2]], spacing: f64) -> Vec<DVec3> {
    let ends = edges.iter().flatten().copied();
    let between = edges.iter().flat_map(|&[a, b]| {
        let parts = (a.distance(b) / spacing).round().max(1.0) as usize;
        (1..parts).map(move |part| a + (b - a) * (part as f64 / parts as f64))
    });
    let mut taken = BTreeSet::new();
    let cell = |x: DVec3| (x / (0.5 * spacing)).to_array().map(|c| c.floor() as i64);
    ends.chain(between).filter(|x| taken.insert(cell(*x))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_kept_and_fine_edges_are_thinned() {
        let (a, b, c) = (DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 0.33, 0.0));
        let points = along(&[[a, b], [b, c]], 0.1);
        assert!(points.contains(&a) && points.contains(&b) && points.contains(&c));
        assert_eq!(points.len(), 11 + 3);
        let fine: Vec<[DVec3; 2]> =
            (0..1000).map(|k| [k, k + 1].map(|k| DVec3::X * (f64::from(k) / 1000.0))).collect();
        assert!((18..=21).contains(&along(&fine, 0.1).len()));
    }
}
