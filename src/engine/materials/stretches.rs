//! The extreme stretches of a body, on which its stable step depends.

use bytemuck::{Pod, Zeroable};

/// Extremes over the particles of a body; one where nothing is stretched.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Stretches {
    /// Smallest principal stretch.
    pub smallest: f64,
    /// Largest principal stretch.
    pub largest: f64,
    /// Smallest ratio of volumes J.
    pub smallest_volume: f64,
    /// Largest ratio of volumes J.
    pub largest_volume: f64,
}

impl Default for Stretches {
    fn default() -> Self {
        Self { smallest: 1.0, largest: 1.0, smallest_volume: 1.0, largest_volume: 1.0 }
    }
}
