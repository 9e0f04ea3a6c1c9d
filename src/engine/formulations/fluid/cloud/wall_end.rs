//! Fluid particles past the ends of walls.

use glam::DMat3;

/// A fluid particle beside the end of a wall, with empty space behind that end.
#[derive(Clone, Copy, Debug)]
pub struct WallEnd {
    /// The particle, as a row of the cloud.
    pub i: usize,
    /// What of a motion is along the wall, for the share that empty space answers for.
    pub along: DMat3,
}
