//! The inside of a closed mesh as a region.

use glam::DVec3;

use super::normals::{Normals, sharp_edges};
use super::topology::Triangles;
use super::tree::Tree;
use crate::shapes::mesh_fault::MeshFault;
use crate::shapes::region::{Aabb, Region};

/// Volume and moments of a closed mesh.
pub(in crate::shapes) struct MeshSolid {
    pub(super) triangles: Triangles,
    pub(super) normals: Normals,
    pub(super) tree: Tree,
    /// Sharp edges by their end points, and tips.
    pub(super) edges: Vec<[DVec3; 2]>,
    bounds: Aabb,
    volume: f64,
}

impl MeshSolid {
    /// Joins and checks triangles given by their corners \[m\]. The orientation of a mesh that faces inward
    /// is reversed.
    ///
    /// # Errors
    /// The triangles are not the surface of a solid.
    pub fn new(corners: &[[DVec3; 3]]) -> Result<Self, MeshFault> {
        let mut triangles = Triangles::join(corners)?;
        let mut neighbors = triangles.neighbors()?;
        let bounds = Aabb::around(triangles.points.iter().copied());
        let volume = volume(&triangles, bounds.center());
        if volume.abs() <= 1e-12 * bounds.extent().length().powi(3) {
            return Err(MeshFault::NoVolume);
        }
        if volume < 0.0 {
            triangles.corners.iter_mut().for_each(|corners| corners.swap(1, 2));
            neighbors = triangles.neighbors()?;
        }
        let boxes: Vec<Aabb> = (0..triangles.corners.len()).map(|n| Aabb::around(triangles.at(n))).collect();
        let tree = Tree::new(&boxes);
        triangles.check_crossings(&boxes, &tree)?;
        let normals = Normals::new(&triangles, &neighbors);
        let edges = sharp_edges(&triangles, &neighbors, &normals);
        Ok(Self { triangles, normals, tree, edges, bounds, volume: volume.abs() })
    }

    /// Vertices \[m\], and those of each triangle, outward.
    pub fn into_triangles(self) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        (self.triangles.points, self.triangles.corners)
    }
}

/// Signed volume of the tetrahedra between the triangles and a point near them, positive for outward
/// orientation \[m³\].
fn volume(triangles: &Triangles, origin: DVec3) -> f64 {
    let six_times = |n: usize| {
        let [a, b, c] = triangles.at(n).map(|corner| corner - origin);
        a.cross(b).dot(c)
    };
    (0..triangles.corners.len()).map(six_times).sum::<f64>() / 6.0
}

impl Region for MeshSolid {
    fn distance(&self, point: DVec3) -> f64 {
        self.nearest(point).signed_distance
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn volume(&self) -> Option<f64> {
        Some(self.volume)
    }
}
