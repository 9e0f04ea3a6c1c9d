//! Boolean combinations of regions: union, intersection, difference.

use glam::DVec3;

use super::cavity;
use super::concentric::Rings;
use super::moments::Moments;
use super::openings;
use super::region::{Aabb, Region};
use super::surface::{Surface, SurfacePoint};

/// Cells that the faces of boxes may make before the volume is integrated numerically.
const MAX_BOX_CELLS: usize = 200_000;

/// Union of the parts.
pub(super) struct Union<R: ?Sized> {
    pub parts: Vec<Box<R>>,
    pub axes: usize,
}

/// Intersection of the parts.
pub(super) struct Intersection {
    pub parts: Vec<Box<dyn Region>>,
    pub axes: usize,
}

/// The first part without the second.
pub(super) struct DifferenceRegion<R: ?Sized> {
    pub whole: Box<R>,
    pub hole: Box<R>,
    pub axes: usize,
}

impl<R: Region + ?Sized> Union<R> {
    /// Whether the boxes about the parts, with `margin` \[m\] added, have nothing in common.
    pub fn is_apart(&self, margin: f64) -> bool {
        let bounds: Vec<Aabb> = self.parts.iter().map(|part| part.bounds().grown(margin)).collect();
        (0..bounds.len()).all(|i| bounds[..i].iter().all(|other| other.is_apart(&bounds[i], self.axes)))
    }
}

impl<R: Region + ?Sized> DifferenceRegion<R> {
    /// Whether all of the hole, with `margin` \[m\] about it, is known to be inside the whole.
    pub fn is_hollow(&self, margin: f64) -> bool {
        holds(self.whole.as_ref(), &self.hole.bounds().grown(margin), self.axes)
    }
}

impl<R: Region + ?Sized> Region for Union<R> {
    fn distance(&self, point: DVec3) -> f64 {
        self.parts.iter().map(|part| part.distance(point)).fold(f64::INFINITY, f64::min)
    }

    fn clearance(&self, point: DVec3) -> f64 {
        self.parts.iter().map(|part| part.clearance(point)).fold(f64::INFINITY, f64::min)
    }

    fn bounds(&self) -> Aabb {
        let first = self.parts[0].bounds();
        self.parts.iter().fold(first, |bounds, part| bounds.union(&part.bounds()))
    }

    fn volume(&self) -> Option<f64> {
        if self.is_apart(0.0) {
            self.parts.iter().map(|part| part.volume()).sum()
        } else {
            volume_of_boxes(self, self.axes)
        }
    }

    fn frame(&self) -> Aabb {
        self.parts[0].frame()
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        self.parts.iter().all(|part| part.box_faces(faces))
    }
}

impl Region for Intersection {
    fn distance(&self, point: DVec3) -> f64 {
        self.parts.iter().map(|part| part.distance(point)).fold(f64::NEG_INFINITY, f64::max)
    }

    fn bounds(&self) -> Aabb {
        let first = self.parts[0].bounds();
        self.parts.iter().fold(first, |bounds, part| bounds.intersection(&part.bounds()))
    }

    fn volume(&self) -> Option<f64> {
        if self.parts.len() == 1 { self.parts[0].volume() } else { volume_of_boxes(self, self.axes) }
    }

    fn frame(&self) -> Aabb {
        let bounded = self.parts.iter().map(|part| part.frame()).find(Aabb::is_bounded);
        bounded.unwrap_or_else(|| self.parts[0].frame())
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        self.parts.iter().all(|part| part.box_faces(faces))
    }
}

impl<R: Region + ?Sized> Region for DifferenceRegion<R> {
    fn distance(&self, point: DVec3) -> f64 {
        self.whole.distance(point).max(-self.hole.distance(point))
    }

    fn clearance(&self, point: DVec3) -> f64 {
        let (whole, hole) = (self.whole.clearance(point), self.hole.distance(point));
        let distance = whole.max(-hole);
        if distance <= 0.0 {
            return distance;
        }
        let edge = || {
            let is_before_both = whole.min(-hole) > 0.0;
            is_before_both.then(|| openings::from_edge(self, point, whole, -hole)).flatten()
        };
        openings::through(self, point, whole, hole).or_else(edge).unwrap_or(distance)
    }

    /// Those of the whole, up to a hole that takes all of one of its ends away.
    fn bounds(&self) -> Aabb {
        let mut bounds = self.whole.bounds();
        for axis in 0..self.axes {
            let Some([from, to]) = self.hole.slab(axis, &bounds) else { continue };
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            if from <= min && to < max {
                bounds.min[axis] = to.max(min);
            } else if to >= max && from > min {
                bounds.max[axis] = from.min(max);
            }
        }
        bounds
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

/// For parts that are apart only: the nearest point of one could be inside another.
impl<R: Surface + ?Sized> Surface for Union<R> {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let nearer =
            |a: SurfacePoint, b: SurfacePoint| if b.signed_distance < a.signed_distance { b } else { a };
        let first = self.parts[0].closest(point);
        self.parts[1..].iter().map(|part| part.closest(point)).fold(first, nearer)
    }

    fn edges(&self, piece: f64) -> Vec<[DVec3; 2]> {
        self.parts.iter().flat_map(|part| part.edges(piece)).collect()
    }

    fn moments(&self) -> Option<Moments> {
        let first = self.parts[0].moments()?;
        self.parts[1..].iter().try_fold(first, |sum, part| Some(sum.joined(part.moments()?, 1.0)))
    }
}

/// For a hole that is all inside only: otherwise the nearest point of either surface could be one of no
/// boundary.
impl<R: Surface + ?Sized> Surface for DifferenceRegion<R> {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let (outer, inner) = (self.whole.closest(point), self.hole.closest(point));
        if outer.signed_distance >= -inner.signed_distance {
            return outer;
        }
        SurfacePoint { point: inner.point, normal: -inner.normal, signed_distance: -inner.signed_distance }
    }

    /// Those of the hole are notches: what touches them has touched its faces before.
    fn edges(&self, piece: f64) -> Vec<[DVec3; 2]> {
        self.whole.edges(piece)
    }

    fn moments(&self) -> Option<Moments> {
        Some(self.whole.moments()?.joined(self.hole.moments()?, -1.0))
    }
}

/// Whether `region` is known to hold all of `part`: it is a single box that does, or a ball about `part` is
/// inside.
fn holds<R: Region + ?Sized>(region: &R, part: &Aabb, axes: usize) -> bool {
    let mut faces = [Vec::new(), Vec::new(), Vec::new()];
    if region.box_faces(&mut faces) && faces[0].len() == 2 {
        return (0..axes).all(|k| faces[k][0] <= part.min[k] && part.max[k] <= faces[k][1]);
    }
    region.distance(part.center()) <= -0.5 * part.extent().length()
}

/// Volume of a region made of boxes along the axes: all their faces cut space into cells that are in or out
/// as a whole.
fn volume_of_boxes<R: Region + ?Sized>(region: &R, axes: usize) -> Option<f64> {
    let mut faces = [Vec::new(), Vec::new(), Vec::new()];
    if !region.box_faces(&mut faces) {
        return None;
    }
    for coordinates in &mut faces {
        coordinates.sort_by(f64::total_cmp);
        coordinates.dedup();
    }
    if axes == 2 {
        faces[2] = vec![-0.5, 0.5];
    }
    if faces.iter().map(|coordinates| coordinates.len()).product::<usize>() > MAX_BOX_CELLS {
        return None;
    }
    let mut volume = 0.0;
    for x in faces[0].windows(2) {
        for y in faces[1].windows(2) {
            for z in faces[2].windows(2) {
                let center = 0.5 * DVec3::new(x[0] + x[1], y[0] + y[1], z[0] + z[1]);
                if region.distance(center) < 0.0 {
                    volume += (x[1] - x[0]) * (y[1] - y[0]) * (z[1] - z[0]);
                }
            }
        }
    }
    Some(volume)
}
