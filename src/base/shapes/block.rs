//! Axis-aligned boxes; rectangles in two dimensions.

use glam::DVec3;

use super::moments::Moments;
use super::region::{Aabb, Region};
use super::surface::{Facing, Surface, SurfacePoint, behind_all};
use crate::linalg::Sym3;

/// An axis-aligned box; in two dimensions a rectangle.
pub(super) struct BoxRegion {
    pub corners: Aabb,
    pub axes: usize,
}

impl Region for BoxRegion {
    fn distance(&self, point: DVec3) -> f64 {
        let mut outside = 0.0;
        let mut nearest = f64::NEG_INFINITY;
        for k in 0..self.axes {
            let out = (self.corners.min[k] - point[k]).max(point[k] - self.corners.max[k]);
            outside += out.max(0.0).powi(2);
            nearest = nearest.max(out);
        }
        nearest.min(0.0) + outside.sqrt()
    }

    fn bounds(&self) -> Aabb {
        self.corners
    }

    fn volume(&self) -> Option<f64> {
        let sides = self.corners.extent();
        Some((0..self.axes).map(|k| sides[k]).product())
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        for k in 0..self.axes {
            faces[k].extend([self.corners.min[k], self.corners.max[k]]);
        }
        true
    }
}

impl Surface for BoxRegion {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let nearer_face = |k: usize| {
            let axis = DVec3::AXES[k];
            let below = Facing { normal: -axis, distance: self.corners.min[k] - point[k] };
            Facing { normal: axis, distance: point[k] - self.corners.max[k] }.outermost(below)
        };
        // Written out, because a mapped array would not be inlined.
        let faces = [nearer_face(0), nearer_face(1), nearer_face(2)];
        behind_all(point, &faces[..self.axes])
    }

    fn edges(&self, _piece: f64) -> Vec<[DVec3; 2]> {
        let corners = self.corners.corners();
        if self.axes == 2 {
            return (0..4).map(|n| [corners[n]; 2]).collect();
        }
        let along = |axis: usize| (0..8).filter(move |n| n >> axis & 1 == 0).map(move |n| (n, n | 1 << axis));
        (0..3).flat_map(along).map(|(n, other)| [corners[n], corners[other]]).collect()
    }

    fn moments(&self) -> Option<Moments> {
        let volume = self.volume()?;
        let sides = self.corners.extent();
        let own = |k: usize| if k < self.axes { volume * sides[k] * sides[k] / 12.0 } else { 0.0 };
        let second = Sym3::from_diagonal(DVec3::new(own(0), own(1), own(2)));
        Some(Moments { volume, center: self.corners.center(), second })
    }
}
