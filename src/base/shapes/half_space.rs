//! Half-spaces, bounded by a plane; half-planes in two dimensions.

use glam::DVec3;

use super::region::{Aabb, Region};
use super::surface::{Facing, Surface, SurfacePoint};

/// The half-space behind the plane through `point` with the unit normal `normal`.
pub(super) struct HalfSpace {
    pub point: DVec3,
    pub normal: DVec3,
    pub axes: usize,
}

impl Region for HalfSpace {
    fn distance(&self, point: DVec3) -> f64 {
        (point - self.point).dot(self.normal)
    }

    fn bounds(&self) -> Aabb {
        Aabb::everything(self.axes)
    }

    fn volume(&self) -> Option<f64> {
        Some(f64::INFINITY)
    }

    fn slab(&self, axis: usize, _within: &Aabb) -> Option<[f64; 2]> {
        let (along, place) = (self.normal[axis], self.point[axis]);
        let is_across = along.abs() == self.normal.length();
        is_across.then_some(if along > 0.0 { [f64::NEG_INFINITY, place] } else { [place, f64::INFINITY] })
    }
}

impl Surface for HalfSpace {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        Facing { normal: self.normal, distance: self.distance(point) }.foot(point)
    }
}
