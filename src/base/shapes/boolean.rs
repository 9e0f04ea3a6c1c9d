//! Unions and intersections of regions.

use glam::DVec3;

use super::apart::TwoSets;
use super::moments::Moments;
use super::region::{Aabb, Region};
use super::surface::{Surface, SurfacePoint};
use super::union_tree::UnionTree;

/// Maximum number of cells between the faces of boxes; beyond it the volume is integrated numerically.
const MAX_BOX_CELLS: usize = 200_000;

/// Union of the parts.
pub(super) struct Union<R: ?Sized> {
    parts: Vec<Box<R>>,
    axes: usize,
    tree: UnionTree,
}

/// Intersection of the parts.
pub(super) struct Intersection {
    pub parts: Vec<Box<dyn Region>>,
    pub axes: usize,
}

impl<R: Region + ?Sized> Union<R> {
    /// The union of these parts, of which there is one at least.
    pub fn new(parts: Vec<Box<R>>, axes: usize) -> Self {
        let bounds: Vec<Aabb> = parts.iter().map(|part| part.bounds()).collect();
        Self { parts, axes, tree: UnionTree::new(&bounds) }
    }

    /// Whether the parts, each extended by `margin` \[m\], are certainly disjoint.
    pub fn is_apart(&self, margin: f64) -> bool {
        (0..self.parts.len()).all(|i| (0..i).all(|j| self.are_apart(i, j, margin)))
    }

    /// Whether two parts are: the boxes around them, or what is in both of these.
    fn are_apart(&self, i: usize, j: usize, margin: f64) -> bool {
        let [a, b] = [i, j].map(|part| self.parts[part].as_ref());
        let [around_a, around_b] = [a, b].map(|part| part.bounds().grown(margin));
        around_a.is_apart(&around_b, self.axes) || {
            let (first, second) = (|point| a.distance(point), |point| b.distance(point));
            let sets = TwoSets { first, second, margin, axes: self.axes };
            sets.are_apart(&around_a.intersection(&around_b))
        }
    }
}

impl<R: Region + ?Sized> Region for Union<R> {
    fn distance(&self, point: DVec3) -> f64 {
        self.tree.smallest(point, |part| self.parts[part].distance(point))
    }

    fn clearance(&self, point: DVec3) -> f64 {
        self.tree.smallest(point, |part| self.parts[part].clearance(point))
    }

    fn bounds(&self) -> Aabb {
        self.tree.bounds()
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

/// Only valid for disjoint parts: otherwise the nearest point of one could be inside another.
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

/// Volume of a region of axis-aligned boxes. Their faces divide space into cells that are entirely inside or
/// outside.
pub(super) fn volume_of_boxes<R: Region + ?Sized>(region: &R, axes: usize) -> Option<f64> {
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
