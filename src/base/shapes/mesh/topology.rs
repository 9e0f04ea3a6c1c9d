//! Whether triangles are the surface of a solid: closed, consistently oriented, without self-intersection.

use std::collections::BTreeMap;

use glam::DVec3;

use super::tree::Tree;
use super::triangle::is_pierced;
use crate::shapes::mesh_fault::MeshFault;
use crate::shapes::region::Aabb;

/// Shared vertices, and triangles as triples of vertices.
pub(super) struct Triangles {
    pub points: Vec<DVec3>,
    pub corners: Vec<[u32; 3]>,
}

impl Triangles {
    /// Merges equal corners. Degenerate triangles, with fewer than three different corners, are discarded;
    /// files of round parts contain some.
    pub fn join(triangles: &[[DVec3; 3]]) -> Result<Self, MeshFault> {
        let mut joined = Self { points: Vec::new(), corners: Vec::new() };
        let mut known = BTreeMap::new();
        for (n, triangle) in triangles.iter().enumerate() {
            if triangle.iter().any(|corner| !corner.is_finite()) {
                return Err(MeshFault::NotFinite(n));
            }
            let numbers = triangle.map(|corner| {
                // Adding zero maps -0 to 0.
                let key = (corner + DVec3::ZERO).to_array().map(f64::to_bits);
                *known.entry(key).or_insert_with(|| {
                    joined.points.push(corner);
                    joined.points.len() as u32 - 1
                })
            });
            let [a, b, c] = numbers;
            if a != b && b != c && c != a {
                joined.corners.push(numbers);
            }
        }
        if joined.corners.is_empty() { Err(MeshFault::NoTriangle) } else { Ok(joined) }
    }

    /// The corners of a triangle \[m\].
    pub fn at(&self, n: usize) -> [DVec3; 3] {
        self.corners[n].map(|corner| self.points[corner as usize])
    }

    /// The triangle on the other side of each edge. Edges are in the order of the corners.
    ///
    /// # Errors
    /// Edges of one or of more than two triangles, or of two with inconsistent orientation.
    pub fn neighbors(&self) -> Result<Vec<[u32; 3]>, MeshFault> {
        let mut edges: BTreeMap<(u32, u32), Vec<(u32, u8)>> = BTreeMap::new();
        for (n, corners) in self.corners.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                edges.entry((a.min(b), a.max(b))).or_default().push((n as u32, k as u8));
            }
        }
        let starts_at = |&(n, k): &(u32, u8)| self.corners[n as usize][usize::from(k)];
        let faults = |wrong: &dyn Fn(&[(u32, u8)]) -> bool| {
            let mut found = edges.iter().filter(|(_, sides)| wrong(sides)).map(|(ends, _)| ends);
            let &(a, b) = found.next()?;
            Some((1 + found.count(), 0.5 * (self.points[a as usize] + self.points[b as usize])))
        };
        if let Some((edges, at)) = faults(&|sides| sides.len() > 2) {
            return Err(MeshFault::Crowded { edges, at });
        }
        if let Some((edges, at)) = faults(&|sides| sides.len() == 1) {
            return Err(MeshFault::Open { edges, at });
        }
        if let Some((edges, at)) = faults(&|sides| starts_at(&sides[0]) == starts_at(&sides[1])) {
            return Err(MeshFault::Orientation { edges, at });
        }
        let mut neighbors = vec![[0; 3]; self.corners.len()];
        for sides in edges.values() {
            for (this, other) in [(sides[0], sides[1]), (sides[1], sides[0])] {
                neighbors[this.0 as usize][usize::from(this.1)] = other.0;
            }
        }
        Ok(neighbors)
    }

    /// # Errors
    /// Triangles intersect.
    pub fn check_crossings(&self, boxes: &[Aabb], tree: &Tree) -> Result<(), MeshFault> {
        let (mut pairs, mut first) = (0, None);
        for (n, bounds) in boxes.iter().enumerate() {
            tree.touching(bounds, |other| {
                let other = other as usize;
                if n < other && bounds.touches(&boxes[other]) && self.cross(n, other) {
                    pairs += 1;
                    first.get_or_insert(n);
                }
            });
        }
        let Some(n) = first else { return Ok(()) };
        let at = self.at(n).iter().sum::<DVec3>() / 3.0;
        Err(MeshFault::Crossing { pairs, at })
    }

    /// Whether an edge of one triangle intersects the other. Edges with a common end point cannot.
    fn cross(&self, n: usize, other: usize) -> bool {
        let pierces = |n: usize, other: usize| {
            (0..3).any(|k| {
                let (p, q) = (self.corners[n][k], self.corners[n][(k + 1) % 3]);
                let meets = |corner: u32| self.corners[other].contains(&corner);
                let point = |corner: u32| self.points[corner as usize];
                !meets(p) && !meets(q) && is_pierced(self.at(other), point(p), point(q))
            })
        };
        pierces(n, other) || pierces(other, n)
    }
}
