//! Difference of two regions.

use glam::DVec3;

use super::apart::TwoSets;
use super::boolean::volume_of_boxes;
use super::cavity;
use super::moments::Moments;
use super::region::{Aabb, Region};
use super::rings::Rings;
use super::surface::{Surface, SurfacePoint};

/// The first region without the second.
pub(super) struct DifferenceRegion<R: ?Sized> {
    pub whole: Box<R>,
    pub hole: Box<R>,
    pub axes: usize,
    /// Kept, as every question whether it contains a point needs them.
    bounds: Aabb,
    hole_bounds: Aabb,
}

impl<R: Region + ?Sized> DifferenceRegion<R> {
    /// The difference, in two or three dimensions.
    pub fn new(whole: Box<R>, hole: Box<R>, axes: usize) -> Self {
        let bounds = bounds_of(whole.as_ref(), hole.as_ref(), axes);
        let hole_bounds = hole.bounds();
        Self { whole, hole, axes, bounds, hole_bounds }
    }

    /// Whether the hole, extended by `margin` \[m\], is certainly inside the whole.
    pub fn is_hollow(&self, margin: f64) -> bool {
        let (whole, hole) = (self.whole.as_ref(), self.hole.as_ref());
        let around = hole.bounds().grown(margin);
        is_box_around(whole, &around, self.axes) || {
            let (first, second) = (|point| -whole.distance(point), |point| hole.distance(point));
            TwoSets { first, second, margin, axes: self.axes }.are_apart(&around)
        }
    }
}

impl<R: Region + ?Sized> Region for DifferenceRegion<R> {
    fn distance(&self, point: DVec3) -> f64 {
        let whole = self.whole.distance(point);
        // The distance from a mesh takes long.
        let to_hole = self.hole_bounds.gap(point);
        if to_hole > 0.0 && to_hole >= -whole { whole } else { whole.max(-self.hole.distance(point)) }
    }

    fn clearance(&self, point: DVec3) -> f64 {
        let (whole, hole) = (self.whole.clearance(point), self.hole.distance(point));
        let distance = whole.max(-hole);
        if distance <= 0.0 {
            return distance;
        }
        let edge = || {
            let is_before_both = whole.min(-hole) > 0.0;
            is_before_both.then(|| self.distance_to_edge(point, whole, -hole)).flatten()
        };
        self.through_opening(point, whole, hole).or_else(edge).unwrap_or(distance)
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn volume(&self) -> Option<f64> {
        if self.whole.bounds().is_apart(&self.hole.bounds(), self.axes) {
            return self.whole.volume();
        }
        if self.is_hollow(0.0) {
            return Some(self.whole.volume()? - self.hole.volume()?);
        }
        volume_of_boxes(self, self.axes)
    }

    fn frame(&self) -> Aabb {
        self.whole.frame()
    }

    fn wall_frame(&self, spacing: f64) -> Option<Aabb> {
        let mut faces = [Vec::new(), Vec::new(), Vec::new()];
        let are_boxes = self.cavity_faces(&mut faces);
        are_boxes.then(|| cavity::frame(&self.whole.frame(), &faces, spacing, self.axes)).flatten()
    }

    fn cavity_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        self.whole.cavity_faces(faces) && self.hole.box_faces(faces)
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        self.whole.box_faces(faces) && self.hole.box_faces(faces)
    }

    fn rings(&self) -> Option<Rings> {
        self.whole.rings()?.bored(self.hole.rings()?)
    }
}

/// Only valid for a hole entirely inside the whole: otherwise the nearest point of either surface might not
/// be on the boundary of the difference.
impl<R: Surface + ?Sized> Surface for DifferenceRegion<R> {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let (outer, inner) = (self.whole.closest(point), self.hole.closest(point));
        if outer.signed_distance >= -inner.signed_distance {
            return outer;
        }
        SurfacePoint { point: inner.point, normal: -inner.normal, signed_distance: -inner.signed_distance }
    }

    /// The edges of the whole alone: those of the hole are concave, and a body touches the adjacent faces
    /// first.
    fn edges(&self, piece: f64) -> Vec<[DVec3; 2]> {
        self.whole.edges(piece)
    }

    fn moments(&self) -> Option<Moments> {
        Some(self.whole.moments()?.joined(self.hole.moments()?, -1.0))
    }
}

/// The bounds of the whole, reduced where a hole removes an entire end of it.
fn bounds_of<R: Region + ?Sized>(whole: &R, hole: &R, axes: usize) -> Aabb {
    let mut bounds = whole.bounds();
    for axis in 0..axes {
        let Some([from, to]) = hole.slab(axis, &bounds) else { continue };
        let (min, max) = (bounds.min[axis], bounds.max[axis]);
        if from <= min && to < max {
            bounds.min[axis] = to.max(min);
        } else if to >= max && from > min {
            bounds.max[axis] = from.min(max);
        }
    }
    bounds
}

/// Whether `region` is a single box that contains `part`.
fn is_box_around<R: Region + ?Sized>(region: &R, part: &Aabb, axes: usize) -> bool {
    let mut faces = [Vec::new(), Vec::new(), Vec::new()];
    region.box_faces(&mut faces)
        && faces[0].len() == 2
        && (0..axes).all(|k| faces[k][0] <= part.min[k] && part.max[k] <= faces[k][1])
}
