//! The moments of all forces on the particles of a boundary.

use glam::DVec3;

use super::friction::FrictionMoments;
use super::pressure::PressureMoments;
use crate::formulations::fluid::cloud::{FlowCloud, Group};
use crate::world::Force;

/// Finds the moments of the forces of a flow, and the forces that make them.
#[derive(Debug, Default)]
pub struct SurfaceMoments {
    friction: FrictionMoments,
    pressure: PressureMoments,
}

impl SurfaceMoments {
    /// Adds these forces to the whole and to its parts.
    pub fn add(&mut self, cloud: &FlowCloud, group: &Group, total: &mut [Force], parts: &mut [DVec3]) {
        self.friction.add(cloud, group, total, parts);
        if let Some(near) = cloud.soft_neighborhood(group) {
            self.pressure.add(cloud, group, near, total, parts);
        }
    }

    /// Adds to `drag` how fast the friction on each particle grows with its velocity, kg/s.
    pub fn add_drag(&self, drag: &mut [f64]) {
        self.friction.add_drag(drag);
    }
}
