//! A rigid body: its position, its motion, the forces on it.

use std::ops::{Deref, DerefMut};

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use super::constraint::Constraint;
use super::nodes::Nodes;
use super::rotation::Inertia;
use super::wrench::Wrench;
use crate::linalg::Sym3;
use crate::parallel::BlockSum;
use crate::scene::Dimension;
use crate::schedule::Shareable;
use crate::shapes::Surface;
use crate::world::BodyId;

/// State of a rigid body; at mid-step the velocities are those of mid-step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidState {
    /// Centre of mass, m.
    pub center: DVec3,
    /// Rotation from the reference configuration.
    pub rotation: DQuat,
    /// Velocity of the centre, m/s.
    pub velocity: DVec3,
    /// Angular momentum about the centre, kg m2/s.
    pub angular_momentum: DVec3,
    /// Angular velocity, 1/s.
    pub angular_velocity: DVec3,
    /// Force on the body at the end of the last step, N.
    pub force: DVec3,
    /// Torque about its centre at the end of the last step, N m.
    pub torque: DVec3,
    /// Whether it has been removed from the run.
    pub gone: bool,
}

impl RigidState {
    /// At rest, with the centre there, m.
    pub fn at(center: DVec3) -> Self {
        Self {
            center,
            rotation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
            angular_momentum: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            force: DVec3::ZERO,
            torque: DVec3::ZERO,
            gone: false,
        }
    }
}

/// Orientation of a rigid body and its change.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning {
    /// Rotation from the reference configuration.
    pub rotation: DQuat,
    /// Angular velocity, 1/s.
    pub angular_velocity: DVec3,
}

/// A rigid body.
pub struct RigidBody {
    /// Index in the scene.
    pub id: BodyId,
    /// Mass, kg; in two dimensions per metre of thickness.
    pub mass: f64,
    /// Inertia about the centre.
    pub inertia: Inertia,
    /// Inverse of the inertia of its particles as points, in the reference configuration.
    pub(super) points: Option<Sym3>,
    /// Centre in the reference configuration, m.
    pub reference_center: DVec3,
    /// Largest distance of a point of the body from its centre, m.
    pub bounding_radius: f64,
    /// Surface in the reference configuration.
    pub surface: Box<dyn Surface>,
    /// Points that touch other surfaces.
    pub nodes: Nodes,
    pub(super) constraint: Constraint,
    /// State.
    pub state: RigidState,
    /// Sum of the contacts of this step, about the centre.
    contact: Wrench,
    /// Stiffness of all contacts of the step, about the centre.
    pub(crate) contact_stiffness: Wrench,
    /// Sum of the arms about the centre times the components of the forces, N m, of the loads of a step
    /// whose direction is kept.
    pub(crate) load_moments: [DVec3; 3],
    /// How it stood and turned before it moved in this step.
    pub(crate) left: Turning,
    /// What drives have added to the velocity of the centre, m/s2, and to the angular velocity, 1/s2, in the
    /// first half of this step.
    pub(super) gained: [DVec3; 2],
}

impl RigidBody {
    /// Whether a condition prescribes the motion along an axis.
    pub fn is_driven_along(&self, axis: usize) -> bool {
        self.constraint.drives.iter().any(|drive| drive.axes[axis])
    }

    /// Magnitude of its acceleration by the forces of the last step, m/s2.
    pub fn last_acceleration(&self) -> f64 {
        (self.state.force / self.mass).length()
    }

    pub(super) fn new(parts: RigidParts, state: RigidState) -> Self {
        let RigidParts { id, mass, inertia, points, bounding_radius, surface, nodes, constraint } = parts;
        let contact = Wrench::default();
        let reference_center = state.center;
        Self {
            id,
            mass,
            inertia,
            points,
            reference_center,
            bounding_radius,
            surface,
            nodes,
            constraint,
            state,
            contact,
            contact_stiffness: Wrench::default(),
            load_moments: [DVec3::ZERO; 3],
            left: Turning { rotation: state.rotation, angular_velocity: state.angular_velocity },
            gained: [DVec3::ZERO; 2],
        }
    }

    /// Where a point of the reference configuration is now.
    pub fn place(&self, reference: DVec3) -> DVec3 {
        self.state.center + self.state.rotation * (reference - self.reference_center)
    }

    /// Where a point of space is in the reference configuration.
    #[inline]
    pub fn reference(&self, place: DVec3) -> DVec3 {
        self.reference_center + self.state.rotation.inverse() * (place - self.state.center)
    }

    /// Velocity of the point of the body that is at `place`, m/s.
    #[inline]
    pub fn velocity_at(&self, place: DVec3) -> DVec3 {
        self.state.velocity + self.state.angular_velocity.cross(place - self.state.center)
    }

    /// Mean velocity in a step of `dt`, s, of the point that is at `place` after it, m/s, less `velocity_at`,
    /// which has the velocities of the mid-step and the arm of the end.
    #[inline]
    pub fn lag_at(&self, place: DVec3, dt: f64) -> DVec3 {
        let spin = self.state.angular_velocity;
        -0.5 * dt * spin.cross(spin.cross(place - self.state.center))
    }

    /// Inverse mass at `place` along `direction`, 1/kg.
    #[inline]
    pub fn inverse_mass_at(&self, place: DVec3, direction: DVec3) -> f64 {
        let lever = (place - self.state.center).cross(direction);
        let spin = self.constraint.angular_response(&self.inertia, self.state.rotation, lever);
        let free = self.constraint.free_axes();
        direction.dot(free * direction) / self.mass + lever.dot(spin)
    }

    /// Acceleration of the point at `place`, m/s2, by forces about the centre.
    #[inline]
    pub fn response_at(&self, place: DVec3, forces: &Wrench) -> DVec3 {
        let spin = self.constraint.angular_response(&self.inertia, self.state.rotation, forces.torque);
        self.constraint.free_axes() * forces.force / self.mass + spin.cross(place - self.state.center)
    }

    /// Acceleration of the point at `place` by the forces of the last step, m/s2.
    #[inline]
    pub fn acceleration_at(&self, place: DVec3) -> DVec3 {
        let RigidState { force, torque, .. } = self.state;
        self.response_at(place, &Wrench { force, torque })
    }

    /// Whether the whole motion is prescribed, so that no force moves it.
    pub fn is_driven(&self) -> bool {
        self.constraint.is_complete()
    }

    /// Whether it turns, freely or driven.
    pub fn may_turn(&self) -> bool {
        !self.constraint.is_held_from_turning()
    }

    /// Bound of the squared frequency, 1/s2, with which it swings in loads of those moments, N m, and of the
    /// angular acceleration that they cause.
    pub(super) fn swing(&self, moments: [DVec3; 3]) -> f64 {
        let response = |torque: DVec3| {
            self.constraint.angular_response(&self.inertia, self.state.rotation, torque).length()
        };
        let [x, y, z] = moments;
        let torque = DVec3::new(z.y - y.z, x.z - z.x, y.x - x.y);
        // Turned by a small angle d, an arm r changes the torque by (d x r) x f = r (f . d) - d (r . f).
        let trace = x.x + y.y + z.z;
        let change = |axis: usize| response(moments[axis] - trace * DVec3::AXES[axis]);
        let first = if self.constraint.dimension == Dimension::Two { 2 } else { 0 };
        (first..3).map(change).fold(0.0, f64::max) + response(torque)
    }

    /// Adds the force of contacts, with the torque about the centre.
    pub fn push(&mut self, contact: &Wrench) {
        self.contact.add(contact);
    }

    /// Takes out the sum of the contacts of this step.
    pub(super) fn take_contact(&mut self) -> Wrench {
        std::mem::take(&mut self.contact)
    }
}

/// Parts of a rigid body.
pub(super) struct RigidParts {
    pub id: BodyId,
    pub mass: f64,
    pub inertia: Inertia,
    pub points: Option<Sym3>,
    pub bounding_radius: f64,
    pub surface: Box<dyn Surface>,
    pub nodes: Nodes,
    pub constraint: Constraint,
}

/// Name of the motion of rigid bodies and of what acts on them, in the access of systems.
pub const RIGID_BODIES: &str = "rigid_bodies";

impl Shareable for RigidBodies {
    const ROWS: &'static [&'static str] = &[RIGID_BODIES];
}

/// The rigid bodies of a simulation, in scene order: a resource of the systems that move them and those that
/// push them.
#[derive(Default)]
pub struct RigidBodies(pub(super) Vec<RigidBody>);

impl RigidBodies {
    /// Its number among them, if a body is rigid.
    fn number(&self, id: BodyId) -> Option<usize> {
        self.0.binary_search_by_key(&id, |body| body.id).ok()
    }

    /// The rigid body of that index in the scene.
    pub fn of(&self, id: BodyId) -> Option<&RigidBody> {
        self.number(id).map(|number| &self.0[number])
    }

    /// The same, to be changed.
    pub fn of_mut(&mut self, id: BodyId) -> Option<&mut RigidBody> {
        self.number(id).map(|number| &mut self.0[number])
    }
}

impl Deref for RigidBodies {
    type Target = [RigidBody];

    fn deref(&self) -> &[RigidBody] {
        &self.0
    }
}

impl DerefMut for RigidBodies {
    fn deref_mut(&mut self) -> &mut [RigidBody] {
        &mut self.0
    }
}
