//! The nearest point of a mesh with its sign.

use glam::DVec3;

use super::solid::MeshSolid;
use super::topology::Triangles;
use super::triangle::{TrianglePart, closest};
use crate::shapes::moments::Moments;
use crate::shapes::region::Region;
use crate::shapes::surface::{Surface, SurfacePoint};

/// The normals that tell inside from outside wherever the nearest point is: on a face its normal, on an edge
/// the mean of both faces, at a corner the mean weighted by angles.
///
/// Bærentzen and Aanæs, Signed distance computation using the angle weighted pseudonormal, IEEE Transactions
/// on Visualization and Computer Graphics 11 (2005), 243-253.
pub(super) struct Normals {
    faces: Vec<DVec3>,
    edges: Vec<[DVec3; 3]>,
    corners: Vec<DVec3>,
}

impl Normals {
    pub fn new(triangles: &Triangles, neighbors: &[[u32; 3]]) -> Self {
        let mut corners = vec![DVec3::ZERO; triangles.points.len()];
        let faces: Vec<DVec3> = (0..neighbors.len())
            .map(|n| {
                let [a, b, c] = triangles.at(n);
                (b - a).cross(c - a).normalize_or_zero()
            })
            .collect();
        for (n, numbers) in triangles.corners.iter().enumerate() {
            let at = triangles.at(n);
            for k in 0..3 {
                let (one, other) = (at[(k + 1) % 3] - at[k], at[(k + 2) % 3] - at[k]);
                corners[numbers[k] as usize] += one.angle_between(other) * faces[n];
            }
        }
        let edges = neighbors
            .iter()
            .zip(&faces)
            .map(|(sides, face)| sides.map(|other| (*face + faces[other as usize]).normalize_or(*face)))
            .collect();
        let corners = corners.into_iter().map(|sum| sum.normalize_or(DVec3::X)).collect();
        Self { faces, edges, corners }
    }
}

/// Cosine of the angle between normals beyond which an edge or corner counts as sharp: 20 degrees.
const SHARP: f64 = 0.94;

/// Edges between faces that meet at an angle, and the tips of cones.
pub(super) fn sharp_edges(
    triangles: &Triangles,
    neighbors: &[[u32; 3]],
    normals: &Normals,
) -> Vec<[DVec3; 2]> {
    let mut edges = Vec::new();
    let mut is_tip = vec![false; triangles.points.len()];
    for (n, (corners, sides)) in triangles.corners.iter().zip(neighbors).enumerate() {
        for k in 0..3 {
            let (corner, other) = (corners[k], sides[k] as usize);
            if normals.corners[corner as usize].dot(normals.faces[n]) < SHARP {
                is_tip[corner as usize] = true;
            }
            if n < other && normals.faces[n].dot(normals.faces[other]) < SHARP {
                let next = corners[(k + 1) % 3];
                edges.push([corner, next].map(|corner| triangles.points[corner as usize]));
            }
        }
    }
    let tips = triangles.points.iter().zip(is_tip).filter(|(_, is_tip)| *is_tip);
    edges.extend(tips.map(|(tip, _)| [*tip; 2]));
    edges
}

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
        // So near to an edge that the direction to it would be round-off, the mean normal is as good.
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
