//! The prescribed part of the motion of a rigid body.

use glam::{DQuat, DVec3};

use super::rotation::Inertia;
use crate::plugin::Prescription;
use crate::scene::Dimension;
use crate::schedule::{Clock, StepError};
use crate::world::BodyId;

/// A velocity of the centre of a rigid body that a condition prescribes.
pub trait Drive: Send + Sync {
    /// Velocity, m/s, at mid-step or at the end of the step; only the axes of the drive count. `center` is
    /// where the centre is, `reference` where it was at the start.
    fn velocity(
        &self,
        end_of_step: bool,
        clock: &Clock,
        center: DVec3,
        reference: DVec3,
    ) -> Result<DVec3, StepError>;
}

/// The prescribed motion of a rigid body along some axes; conditions add it with
/// [`SimBuilder::extend`](crate::plugin::SimBuilder::extend).
pub struct DrivenBody {
    /// Body.
    pub body: BodyId,
    /// The prescription of the condition.
    pub motion: Prescription,
    /// Axes that it prescribes.
    pub axes: [bool; 3],
    /// The velocity.
    pub drive: Box<dyn Drive>,
}

/// A symmetry plane through a rigid body, which must not leave its place along the axis: only what touches it
/// on one side pushes it.
pub struct HalvedBody {
    /// Body.
    pub body: BodyId,
    /// Axis that the plane is normal to.
    pub axis: usize,
}

/// A prescribed rotation of a rigid body about an axis through its centre; conditions add it with
/// [`SimBuilder::extend`](crate::plugin::SimBuilder::extend).
pub struct DrivenRotation {
    /// Body.
    pub body: BodyId,
    /// Name of the condition.
    pub by: &'static str,
    /// Unit vector along the axis.
    pub axis: DVec3,
    /// Rate, 1/s; the components of the velocity are not used except the first.
    pub rate: Box<dyn Drive>,
}

/// How a body may turn.
pub(super) enum RotationConstraint {
    Free,
    Held,
    /// Freely about one axis, a unit vector.
    About(DVec3),
    Driven(DrivenRotation),
}

/// The prescribed part of the motion of a body.
pub(super) struct Constraint {
    pub drives: Vec<DrivenBody>,
    pub turning: RotationConstraint,
    /// Of the scene: nothing moves a body of the plane out of it.
    pub dimension: Dimension,
}

impl Constraint {
    /// One along the axes along which the centre moves freely, else zero.
    #[inline]
    pub fn free_axes(&self) -> DVec3 {
        let driven = |axis: usize| self.drives.iter().any(|drive| drive.axes[axis]);
        DVec3::from_array([0, 1, 2].map(|axis| if driven(axis) { 0.0 } else { 1.0 }))
    }

    /// Whether the whole motion is prescribed.
    pub fn is_complete(&self) -> bool {
        self.moves_as_prescribed() && self.turns_as_prescribed()
    }

    /// Whether no force moves the centre.
    pub fn moves_as_prescribed(&self) -> bool {
        let free = self.free_axes();
        (0..self.dimension.count()).all(|axis| free[axis] == 0.0)
    }

    /// Whether no torque turns it.
    pub fn turns_as_prescribed(&self) -> bool {
        matches!(self.turning, RotationConstraint::Held | RotationConstraint::Driven(_))
    }

    /// Whether it does not turn at all.
    pub fn is_held_from_turning(&self) -> bool {
        matches!(self.turning, RotationConstraint::Held)
    }

    /// Sets the prescribed components of a velocity of the centre.
    pub fn set_velocity(
        &self,
        end_of_step: bool,
        clock: &Clock,
        center: DVec3,
        reference: DVec3,
        velocity: &mut DVec3,
    ) -> Result<(), StepError> {
        for drive in &self.drives {
            let value = drive.drive.velocity(end_of_step, clock, center, reference)?;
            for axis in (0..3).filter(|&axis| drive.axes[axis]) {
                velocity[axis] = value[axis];
            }
        }
        Ok(())
    }

    /// Angular acceleration of a torque, 1/s2 for N m.
    pub fn angular_response(&self, inertia: &Inertia, rotation: DQuat, torque: DVec3) -> DVec3 {
        match &self.turning {
            RotationConstraint::Free => inertia.angular_velocity(rotation, torque),
            RotationConstraint::About(axis) => {
                let moment = axis.dot(inertia.angular_momentum(rotation, *axis));
                *axis * (axis.dot(torque) / moment)
            }
            RotationConstraint::Held | RotationConstraint::Driven(_) => DVec3::ZERO,
        }
    }
}
