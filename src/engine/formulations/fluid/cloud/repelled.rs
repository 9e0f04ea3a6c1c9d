//! Fluid particles that boundaries repel.

use glam::DVec3;

/// The repulsion of one fluid particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Repelled {
    /// The particle, as a row of the cloud.
    pub i: usize,
    /// First row of the boundary in the cloud.
    pub boundary: usize,
    /// Distance from its shape, m.
    pub distance: f64,
    /// Force on the particle, N; before that is known, over `l_i - d`, N/m.
    pub force: DVec3,
    /// How the opposite is given to the particles of the boundary.
    pub shares: Shares,
}

/// Shares of particles near a point in what acts there, `V_w W (1 + (x_w - x_i - mean) . slope) / total`: they add up to one, and their centre is the point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shares {
    pub total: f64,
    pub mean: DVec3,
    pub slope: DVec3,
    /// The particle that bears all of it, if there is one.
    pub only: Option<u32>,
}
