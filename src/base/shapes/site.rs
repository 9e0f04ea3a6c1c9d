//! A place of a particle, and a region that gets particles.

use glam::DVec3;

use super::region::Region;

/// Where a particle is, and how much of the shape it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Position \[m\]; z is 0 in two dimensions.
    pub position: DVec3,
    /// Volume \[m³\]; in two dimensions area \[m²\], the volume of a slice 1 m thick.
    pub volume: f64,
}

/// A region that gets particles.
#[derive(Clone, Copy)]
pub(super) struct Content<'a> {
    pub region: &'a dyn Region,
    /// Volume of all particles, m3.
    pub volume: f64,
    pub spacing: f64,
    /// Number of axes of the scene.
    pub axes: usize,
}
