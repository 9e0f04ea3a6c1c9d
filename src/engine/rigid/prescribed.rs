//! The acceleration of a rigid body as far as its motion is prescribed: what a fluid beside it can know
//! before it has pushed the body.

use glam::DVec3;

use super::body::RigidBody;
use super::constraint::Turning;

/// Prescribed acceleration of the points of a rigid body in a step.
#[derive(Clone, Copy, Debug)]
pub struct PrescribedAcceleration {
    /// Centre of mass, m.
    center: DVec3,
    /// That of the centre along the axes that are driven, m/s2.
    linear: DVec3,
    /// That of a rotation that is driven, 1/s2, and the angular velocity of it, 1/s.
    angular: DVec3,
    spin: DVec3,
}

impl PrescribedAcceleration {
    /// That of the point at `place`, m/s2.
    #[inline]
    pub fn at(&self, place: DVec3) -> DVec3 {
        let arm = place - self.center;
        self.linear + self.angular.cross(arm) + self.spin.cross(self.spin.cross(arm))
    }
}

impl RigidBody {
    /// That of this step; none where nothing is prescribed.
    pub fn prescribed_acceleration(&self) -> Option<PrescribedAcceleration> {
        let turns = matches!(self.constraint.turning, Turning::Driven(_));
        if self.state.gone || !(turns || self.constraint.free_axes() != DVec3::ONE) {
            return None;
        }
        let [linear, angular] = self.gained;
        let spin = if turns { self.state.angular_velocity } else { DVec3::ZERO };
        Some(PrescribedAcceleration { center: self.state.center, linear, angular, spin })
    }

    /// Takes what drives have added to its velocities within `half` a step, s, since they were `before`, of
    /// the centre and of the rotation.
    pub(super) fn note_drives(&mut self, before: [DVec3; 2], half: f64) {
        let per_time = if half > 0.0 { half.recip() } else { 0.0 };
        let turns = matches!(self.constraint.turning, Turning::Driven(_));
        let angular = if turns { self.state.angular_velocity - before[1] } else { DVec3::ZERO };
        self.gained = [per_time * (self.state.velocity - before[0]), per_time * angular];
    }
}
