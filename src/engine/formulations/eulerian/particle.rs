//! A particle as its neighbours read it.

use bytemuck::{Pod, Zeroable};

use crate::parallel::Lanes4;
use crate::symmetry::Map;

/// A particle as its neighbours read it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub(super) struct EulerianParticle {
    /// x, and the reference volume V_0 in the last lane: zero for a removed particle.
    pub place: Lanes4,
    /// v, and the present volume V in the last lane.
    pub velocity: Lanes4,
}

impl EulerianParticle {
    pub fn image(&self, map: &Map) -> Self {
        Self {
            place: Lanes4::new(map.place(self.place.xyz()), self.place.0[3]),
            velocity: Lanes4::new(map.vector(self.velocity.xyz()), self.velocity.0[3]),
        }
    }
}
