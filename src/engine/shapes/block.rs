//! Boxes along the axes; rectangles in two dimensions.

use glam::DVec3;

use super::region::{Aabb, Region};
use super::surface::{Facing, Surface, SurfacePoint, behind_all};

/// A box along the axes; in two dimensions a rectangle.
pub(super) struct Block {
    pub corners: Aabb,
    pub axes: usize,
}

impl Region for Block {
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

impl Surface for Block {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let nearer_face = |k: usize| {
            let axis = DVec3::AXES[k];
            let below = Facing { normal: -axis, distance: self.corners.min[k] - point[k] };
            Facing { normal: axis, distance: point[k] - self.corners.max[k] }.outermost(below)
        };
        let faces = [0, 1, 2].map(nearer_face);
        behind_all(point, &faces[..self.axes])
    }
}
