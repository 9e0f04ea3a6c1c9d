//! Normals of a mesh, and its sharp edges.

use glam::DVec3;

use super::topology::Triangles;

/// Pseudonormals, which give the sign of the distance for any nearest point: the normal on a face, the mean
/// of both faces on an edge, the angle-weighted mean at a vertex.
///
/// Bærentzen and Aanæs, Signed distance computation using the angle weighted pseudonormal, IEEE Transactions
/// on Visualization and Computer Graphics 11 (2005), 243-253.
pub(super) struct Normals {
    pub faces: Vec<DVec3>,
    pub edges: Vec<[DVec3; 3]>,
    pub corners: Vec<DVec3>,
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

/// Cosine of the angle between normals beyond which an edge or vertex is sharp, 20 degrees.
const SHARP: f64 = 0.94;

/// Sharp edges between faces, and the tips of cones.
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
