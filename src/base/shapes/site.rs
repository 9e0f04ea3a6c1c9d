//! The position and volume of a particle, and a region to be filled.

use glam::DVec3;

use super::region::Region;

/// Position and volume of a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Position \[m\]; z is 0 in two dimensions.
    pub position: DVec3,
    /// Volume \[m³\]; in two dimensions area \[m²\], the volume of a slice 1 m thick.
    pub volume: f64,
}

/// A region to be filled with particles.
#[derive(Clone, Copy)]
pub(super) struct Content<'a> {
    pub region: &'a dyn Region,
    /// Volume of all particles, m3.
    pub volume: f64,
    pub spacing: f64,
    /// Number of space dimensions of the scene.
    pub axes: usize,
}
