//! The nearest point of a mesh, with the signed distance.

use glam::DVec3;

use super::solid::MeshSolid;
use super::triangle::{TrianglePart, closest};
use crate::shapes::moments::Moments;
use crate::shapes::region::Region;
use crate::shapes::surface::{Surface, SurfacePoint};

impl MeshSolid {
    /// The nearest point, its normal and the signed distance to it.
    pub(super) fn nearest(&self, point: DVec3) -> SurfacePoint {
        let mut best = (f64::INFINITY, 0, point, TrianglePart::Face);
        self.tree.nearest(point, |triangle| {
            let (foot, part) = closest(point, self.triangles.at(triangle as usize));
            let square = point.distance_squared(foot);
            if square < best.0 {
                best = (square, triangle as usize, foot, part);
            }
            best.0
        });
        let (_, triangle, foot, part) = best;
        let arm = point - foot;
        let normal = match part {
            TrianglePart::Face => {
                let normal = self.normals.faces[triangle];
                return SurfacePoint { point: foot, normal, signed_distance: arm.dot(normal) };
            }
            TrianglePart::Edge(k) => self.normals.edges[triangle][k],
            TrianglePart::Corner(k) => self.normals.corners[self.triangles.corners[triangle][k] as usize],
        };
        let sign = if arm.dot(normal) < 0.0 { -1.0 } else { 1.0 };
        // Very near to an edge the direction to it is dominated by round-off, and the mean normal replaces
        // it.
        let direction = if arm.length() > self.tolerance() { sign * arm.normalize() } else { normal };
        SurfacePoint { point: foot, normal: direction, signed_distance: sign * arm.length() }
    }
}

impl Surface for MeshSolid {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        self.nearest(point)
    }

    fn edges(&self, _piece: f64) -> Vec<[DVec3; 2]> {
        self.edges.clone()
    }

    fn moments(&self) -> Option<Moments> {
        let origin = self.bounds().center();
        let tetrahedra = (0..self.triangles.corners.len()).map(|n| {
            let corners = self.triangles.at(n).map(|corner| corner - origin);
            let [a, b, c] = corners;
            (a.cross(b).dot(c) / 6.0, corners)
        });
        Some(Moments::of_simplices(origin, 3, tetrahedra))
    }
}
