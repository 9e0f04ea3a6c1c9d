//! A closed surface of flat facets, and the surface of a shape in facets.

use std::path::Path;

use glam::DVec3;

use super::super::shape::Shape;
use super::{grids, outline};
use crate::space::Dimension;

/// A closed surface of flat facets.
#[derive(Clone, Debug, Default)]
pub struct Facets {
    /// 2 or 3.
    pub axes: usize,
    /// Vertices, on the surface \[m\].
    pub points: Vec<DVec3>,
    /// Vertices of every facet; segments use the first two. The outward normal is to the right of a segment,
    /// and triangles are counter-clockwise seen from outside.
    pub corners: Vec<[u32; 3]>,
}

impl Facets {
    /// The vertices of a facet for the given positions.
    pub(super) fn ends(&self, facet: usize) -> [DVec3; 3] {
        self.corners[facet].map(|k| self.points[k as usize])
    }

    /// Centroid of a facet \[m\].
    pub fn center(&self, facet: usize) -> DVec3 {
        let [a, b, c] = self.ends(facet);
        if self.axes == 2 { 0.5 * (a + b) } else { (a + b + c) / 3.0 }
    }

    /// Unit normal, and length (area in three dimensions) \[m; m2\].
    pub fn normal_and_measure(&self, facet: usize) -> (DVec3, f64) {
        let directed = directed_area(self.axes, &self.ends(facet));
        let measure = directed.length();
        (directed.normalize_or_zero(), measure)
    }

    /// Whether the segments form disjoint closed lines: each point is the end of one segment and the start of
    /// another.
    pub(super) fn is_closed_line(&self) -> bool {
        let mut ends = vec![[0; 2]; self.points.len()];
        for [a, b, _] in &self.corners {
            ends[*a as usize][0] += 1;
            ends[*b as usize][1] += 1;
        }
        ends.iter().all(|of| *of == [1, 1])
    }

    /// Appends another surface, with reversed orientation if it bounds a hole.
    pub(super) fn join(&mut self, other: &Self, is_hole: bool) {
        let first = self.points.len() as u32;
        self.points.extend_from_slice(&other.points);
        self.corners.extend(other.corners.iter().map(|&[a, b, c]| {
            let [a, b, c] = [a + first, b + first, c + first];
            match (is_hole, other.axes) {
                (false, _) => [a, b, c],
                (true, 2) => [b, a, a],
                (true, _) => [a, c, b],
            }
        }));
    }

    pub(super) fn moved(mut self, to: impl Fn(DVec3) -> DVec3) -> Self {
        self.points.iter_mut().for_each(|point| *point = to(*point));
        self
    }
}

/// Outward normal times length (area) of a facet with the given vertices \[m; m2\].
pub fn directed_area(axes: usize, [a, b, c]: &[DVec3; 3]) -> DVec3 {
    let ab = b - a;
    if axes == 2 { DVec3::new(ab.y, -ab.x, 0.0) } else { 0.5 * ab.cross(c - a) }
}

impl Shape {
    /// The surface of a checked shape in facets of about `length` \[m\]; `None` for particle files and for
    /// meshes that are much finer.
    pub fn facets(&self, dimension: Dimension, folder: &Path, length: f64) -> Option<Facets> {
        match dimension {
            Dimension::Two => outline::of_shape(self, folder, length),
            Dimension::Three => grids::of_shape(self, folder, length),
        }
    }
}
