//! Prescribed part of the acceleration of a rigid body. It does not depend on the forces of the step, so that
//! the pressure of a fluid on the body can include it.

use glam::DVec3;

use super::body::RigidBody;
use super::constraint::RotationConstraint;

/// Prescribed acceleration of the points of a rigid body in a step.
#[derive(Clone, Copy, Debug)]
pub struct PrescribedAcceleration {
    /// Centre of mass, m.
    center: DVec3,
    /// Acceleration of the centre along the driven axes, m/s2.
    linear: DVec3,
    /// Angular acceleration, 1/s2, and angular velocity, 1/s, of a driven rotation.
    angular: DVec3,
    spin: DVec3,
}

impl PrescribedAcceleration {
    /// Prescribed acceleration of the point at `place`, m/s2.
    #[inline]
    pub fn at(&self, place: DVec3) -> DVec3 {
        let arm = place - self.center;
        self.linear + self.angular.cross(arm) + self.spin.cross(self.spin.cross(arm))
    }
}

impl RigidBody {
    /// The prescribed acceleration in this step; none where no motion is prescribed.
    pub fn prescribed_acceleration(&self) -> Option<PrescribedAcceleration> {
        let turns = matches!(self.constraint.turning, RotationConstraint::Driven(_));
        if self.state.gone || !(turns || self.constraint.free_axes() != DVec3::ONE) {
            return None;
        }
        let [linear, angular] = self.gained;
        let spin = if turns { self.state.angular_velocity } else { DVec3::ZERO };
        Some(PrescribedAcceleration { center: self.state.center, linear, angular, spin })
    }

    /// Stores the changes of its velocities by prescribed motions over `half` a step, s; `before` are the
    /// velocities of the centre, m/s, and of the rotation, 1/s, at its start.
    pub(super) fn note_drives(&mut self, before: [DVec3; 2], half: f64) {
        let per_time = if half > 0.0 { half.recip() } else { 0.0 };
        let turns = matches!(self.constraint.turning, RotationConstraint::Driven(_));
        let angular = if turns { self.state.angular_velocity - before[1] } else { DVec3::ZERO };
        self.gained = [per_time * (self.state.velocity - before[0]), per_time * angular];
    }
}
