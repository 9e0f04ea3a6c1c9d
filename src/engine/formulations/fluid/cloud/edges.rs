//! Edges between boundaries that move relative to each other: the effect of their particles on the fluid.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::repelled::Shares;

/// The faces and the particles at all edges.
#[derive(Debug, Default)]
pub struct BoundaryEdges {
    pub fronts: Vec<Front>,
    /// In the order of rows.
    pub particles: Vec<EdgeParticle>,
    /// Rows of the boundaries that may have edges in this step, in their order.
    pub rows: Vec<Range<usize>>,
}

impl BoundaryEdges {
    /// Whether the boundary of that row may have edges.
    pub fn may_be_of(&self, row: usize) -> bool {
        let at = self.rows.partition_point(|rows| rows.end <= row);
        self.rows.get(at).is_some_and(|rows| rows.contains(&row))
    }
}

/// The face of a boundary before a fluid particle.
#[derive(Clone, Copy, Debug)]
pub struct Front {
    /// The fluid particle, as a row of the cloud.
    pub i: usize,
    /// First row of the boundary in the cloud.
    pub boundary: usize,
    /// Direction out of the face.
    pub normal: DVec3,
    /// Weight, 0 to 1, decreasing with the distance of the particle.
    pub weight: f64,
    /// Distance of the particle from it, m.
    pub distance: f64,
    /// Spacing of the boundary, m.
    pub spacing: f64,
    /// Velocity of the boundary there, m/s.
    pub velocity: DVec3,
    /// Distribution of the force on the face to the particles of the boundary.
    pub shares: Shares,
    /// Force taken over by other boundaries: all of it, and the part that is due to their own pressure, N.
    pub force: [DVec3; 2],
}

/// A boundary particle beside the faces of several boundaries.
#[derive(Clone, Copy, Debug)]
pub struct EdgeParticle {
    /// Its row in the cloud.
    pub row: usize,
    /// Share of it that is behind the faces of other boundaries, 0 to 1.
    pub behind: f64,
    /// Inverse of the moments of the normals around it, with its own weight, times this share.
    pub inverse: DMat3,
    /// Weight of the particle itself.
    pub own: f64,
    /// Velocity at which the faces around it move, less its own, m/s.
    pub excess: DVec3,
    /// Contribution to the rate of compression beside it, over the share of the kernel that fluids fill, 1/s.
    pub rate: f64,
    /// Force handed over to the faces of all boundaries: all of it, and the part that is due to its own
    /// pressure, N.
    pub force: [DVec3; 2],
}
