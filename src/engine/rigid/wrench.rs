//! A force and its torque.

use glam::DVec3;

use crate::parallel::BlockSum;

/// Force, N, and torque about a point, N m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force, N.
    pub force: DVec3,
    /// Torque, N m.
    pub torque: DVec3,
}

impl Wrench {
    /// Adds a force, N, that acts `arm`, m, beside the point.
    pub fn push(&mut self, arm: DVec3, force: DVec3) {
        self.force += force;
        self.torque += arm.cross(force);
    }
}

impl BlockSum for Wrench {
    fn add(&mut self, next: &Self) {
        self.force += next.force;
        self.torque += next.torque;
    }
}
