//! Acceleration of a rigid body, as the pressure of a fluid on it includes it: the prescribed part, which
//! does not depend on the forces of the step, and what is known of the rest.

use glam::DVec3;

use super::body::RigidBody;
use super::constraint::RotationConstraint;

/// Acceleration of the points of a rigid body in a step.
#[derive(Clone, Copy, Debug)]
pub struct RigidAcceleration {
    /// Centre of mass, m.
    center: DVec3,
    /// Acceleration of the centre, m/s2.
    linear: DVec3,
    /// Angular acceleration, 1/s2, and the angular velocity that turns its points, 1/s.
    angular: DVec3,
    spin: DVec3,
}

impl RigidAcceleration {
    /// Acceleration of the point at `place`, m/s2.
    #[inline]
    pub fn at(&self, place: DVec3) -> DVec3 {
        let arm = place - self.center;
        self.linear + self.angular.cross(arm) + self.spin.cross(self.spin.cross(arm))
    }
}

impl RigidBody {
    /// The acceleration whose part of the centre, m/s2, and of the rotation, 1/s2, are `gains`.
    pub fn acceleration(&self, [linear, angular]: [DVec3; 2]) -> RigidAcceleration {
        let (center, spin) = (self.state.center, self.state.angular_velocity);
        RigidAcceleration { center, linear, angular, spin }
    }

    /// What no condition prescribes of a motion of the centre and the rotation.
    pub fn free_part(&self, [linear, angular]: [DVec3; 2]) -> [DVec3; 2] {
        let turns = !self.constraint.turns_as_prescribed();
        [self.constraint.free_axes() * linear, if turns { angular } else { DVec3::ZERO }]
    }

    /// The prescribed part of the acceleration of the centre, m/s2, and of the rotation, 1/s2, in this step.
    pub fn driven_part(&self) -> [DVec3; 2] {
        if self.state.gone { [DVec3::ZERO; 2] } else { self.gained }
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
