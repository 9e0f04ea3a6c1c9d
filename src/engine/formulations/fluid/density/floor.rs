//! The lowest place of the boundaries of a flow that do not fall: what has fallen below it falls on.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::formulations::fluid::cloud::Group;
use crate::formulations::fluid::lanes::FlowParticle;
use crate::parallel::{BlockSum, sum_over_own_blocks};
use crate::plugin::SimBuilder;

/// Acceleration of gravity along the axes that are not periodic, m/s2.
pub fn open_gravity(sim: &SimBuilder<'_>) -> DVec3 {
    let is_open = sim.periodic().lengths().cmpeq(DVec3::ZERO);
    DVec3::select(is_open, sim.gravity(), DVec3::ZERO)
}

/// The level of the lowest particle of walls, deformable bodies, and rigid bodies that something holds.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    down: DVec3,
    /// Depth along that direction, m; infinite without gravity and without them.
    depth: f64,
}

/// Largest depth, m.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(transparent)]
struct LargestDepth(f64);

impl Default for LargestDepth {
    fn default() -> Self {
        Self(f64::NEG_INFINITY)
    }
}

impl BlockSum for LargestDepth {
    fn add(&mut self, next: &Self) {
        self.0 = self.0.max(next.0);
    }
}

impl Floor {
    /// That of the boundaries among the groups, under this gravity, m/s2.
    pub fn of(gravity: DVec3, groups: &[Group], records: &[FlowParticle]) -> Self {
        let down = gravity.normalize_or_zero();
        let staying = groups.iter().filter(|group| group.stays());
        let of = |group: &Group| {
            let deepest =
                sum_over_own_blocks(&records[group.cloud.clone()], &|_, records: &[FlowParticle]| {
                    let there = records.iter().filter(|record| record.volume() > 0.0);
                    let depths = there.map(|record| record.position().dot(down));
                    LargestDepth(depths.fold(f64::NEG_INFINITY, f64::max))
                });
            deepest.0
        };
        let depth = staying.map(of).fold(f64::NEG_INFINITY, f64::max);
        let is_there = down != DVec3::ZERO && depth > f64::NEG_INFINITY;
        Self { down, depth: if is_there { depth } else { f64::INFINITY } }
    }

    /// Whether it is above a particle.
    pub fn is_above(&self, record: &FlowParticle) -> bool {
        record.position().dot(self.down) > self.depth
    }
}
