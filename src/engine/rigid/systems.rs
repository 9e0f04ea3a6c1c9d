//! The systems that move rigid bodies: kick and drift of the body, the second kick, motion of the particles.

use glam::{DMat3, DVec3};

use super::body::{RIGID_BODIES, RigidBodies, RigidBody, RigidState, Turning};
use super::constraint::RotationConstraint;
use super::followed::FollowedFunctions;
use super::wrench::Wrench;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::plugin::SimBuilder;
use crate::schedule::{AccountKind, Clock, Mode, Resources, Run, Stage, Step, StepError, System};
use crate::world::{BodyId, BodySet, Force, Mass, PhaseId, Position, ReferencePosition, Removed, Velocity};

/// Label of the system that moves rigid bodies by the first kick and the drift.
const RIGID_DRIFT: &str = "rigid_drift";
/// Label of the system that gives rigid bodies their weight.
const RIGID_WEIGHT: &str = "rigid_weight";
/// Label of the system that sums the forces on rigid bodies and makes the second kick.
const RIGID_KICK: &str = "rigid_kick";

/// Adds the systems of all rigid bodies.
pub(super) fn add(sim: &mut SimBuilder<'_>, ids: BodySet, followed: FollowedFunctions) {
    let phases: Vec<PhaseId> = sim.phases_of(&ids);
    let (gravity, end) = (sim.gravity(), sim.scene().time.end);
    sim.add_system(
        System::new(Stage::InitialIntegrate, RIGID_DRIFT, RigidDrift { gravity })
            .on_phases(phases.clone())
            .touches_packed(RIGID_BODIES, Mode::Writes)
            .reads::<ReferencePosition>()
            .writes::<Position>()
            .writes::<Velocity>(),
    );
    sim.add_system(
        System::each::<(&mut Force, &Mass, &Removed)>(
            Stage::Rates,
            RIGID_WEIGHT,
            ids,
            move |_, (force, mass, removed)| {
                force.0 = if *removed == Removed::NO { gravity * mass.0 } else { DVec3::ZERO };
            },
        )
        .on_phases(phases.clone()),
    );
    sim.add_system(
        System::new(Stage::FinalIntegrate, RIGID_KICK, RigidKick { end, followed })
            .on_phases(phases)
            .touches_packed(RIGID_BODIES, Mode::Writes)
            .reads::<Position>()
            .reads::<Mass>()
            .writes::<Velocity>()
            .writes::<Force>(),
    );
}

impl RigidBody {
    /// Half a kick, s, with the force and torque of the state.
    fn kick(&mut self, half: f64) {
        let free = self.constraint.free_axes();
        self.state.velocity += half / self.mass * (free * self.state.force);
        let torque = half * self.state.torque;
        let (inertia, rotation) = (&self.inertia, self.state.rotation);
        match &self.constraint.turning {
            RotationConstraint::Free => {
                self.state.angular_momentum += torque;
                self.state.angular_velocity = inertia.angular_velocity(rotation, self.state.angular_momentum);
            }
            RotationConstraint::About(_) => {
                self.state.angular_velocity += self.constraint.angular_response(inertia, rotation, torque);
            }
            RotationConstraint::Held | RotationConstraint::Driven(_) => {}
        }
        self.refresh();
    }

    /// Pushes with a force and a torque, N and N m, for half a step, s, at its end, and changes those of the
    /// state. Returns the gain of kinetic energy and the work that constraints supply, J.
    pub(crate) fn correct(&mut self, push: [DVec3; 2], change: [DVec3; 2], half: f64) -> (f64, f64) {
        let before = (self.kinetic(), self.state.force, self.state.torque);
        [self.state.force, self.state.torque] = push;
        let constraints = -half * self.constraint_power();
        self.kick(half);
        self.state.force = before.1 + change[0];
        self.state.torque = before.2 + change[1];
        (self.kinetic() - before.0, constraints)
    }

    /// Angular velocity and momentum fit each other and the constraint.
    fn refresh(&mut self) {
        let (inertia, state) = (&self.inertia, &mut self.state);
        match &self.constraint.turning {
            RotationConstraint::Free => {
                state.angular_velocity = inertia.angular_velocity(state.rotation, state.angular_momentum);
                return;
            }
            RotationConstraint::About(axis) => {
                state.angular_velocity = *axis * axis.dot(state.angular_velocity)
            }
            RotationConstraint::Held => state.angular_velocity = DVec3::ZERO,
            RotationConstraint::Driven(_) => {}
        }
        state.angular_momentum = inertia.angular_momentum(state.rotation, state.angular_velocity);
    }

    /// Sets the prescribed parts of the velocities. Returns the work that this takes, J.
    fn drive(&mut self, end_of_step: bool, clock: &Clock) -> Result<f64, StepError> {
        let before = self.kinetic();
        let (center, reference) = (self.state.center, self.reference_center);
        self.constraint.set_velocity(end_of_step, clock, center, reference, &mut self.state.velocity)?;
        if let RotationConstraint::Driven(driven) = &self.constraint.turning {
            let rate = driven.rate.velocity(end_of_step, clock, center, reference)?;
            self.state.angular_velocity = driven.axis * rate.x;
        }
        self.refresh();
        Ok(self.kinetic() - before)
    }

    /// Power of force and torque on the prescribed motion, W: the work on the constraints.
    fn constraint_power(&self) -> f64 {
        let held = DVec3::ONE - self.constraint.free_axes();
        let turning = match self.constraint.turning {
            RotationConstraint::Driven(_) => self.state.torque.dot(self.state.angular_velocity),
            _ => 0.0,
        };
        (held * self.state.force).dot(self.state.velocity) + turning
    }

    fn drift(&mut self, dt: f64) {
        self.state.center += dt * self.state.velocity;
        let state = &mut self.state;
        self.left = Turning { rotation: state.rotation, angular_velocity: state.angular_velocity };
        state.rotation = match &self.constraint.turning {
            RotationConstraint::Free => self.inertia.turn(state.rotation, state.angular_momentum, dt),
            RotationConstraint::Held => state.rotation,
            RotationConstraint::About(_) | RotationConstraint::Driven(_) => {
                (glam::DQuat::from_scaled_axis(dt * state.angular_velocity) * state.rotation).normalize()
            }
        };
        self.refresh();
    }

    /// Takes the body out of the run in a step of length `dt`, s, and returns the kinetic energy with which
    /// it goes, J: after a last kick by the forces of the step before.
    pub fn take_out(&mut self, dt: f64) -> f64 {
        self.kick(0.5 * dt);
        let kinetic = self.kinetic();
        let RigidState { center, rotation, .. } = self.state;
        self.state = RigidState { center, rotation, gone: true, ..RigidState::at(center) };
        kinetic
    }

    /// Kinetic energy, J.
    pub fn kinetic(&self) -> f64 {
        let RigidState { velocity, angular_velocity, angular_momentum, .. } = &self.state;
        let moving = if self.mass.is_finite() { self.mass * velocity.length_squared() } else { 0.0 };
        0.5 * (moving + angular_velocity.dot(*angular_momentum))
    }
}

/// Whether a body is rigid.
pub(crate) fn is_rigid(step: &Step<'_>, body: BodyId) -> bool {
    let bodies = step.resources.try_get::<RigidBodies>();
    bodies.is_some_and(|bodies| bodies.iter().any(|rigid| rigid.id == body))
}

/// Takes a rigid body out of the run, and returns the kinetic energy with which it goes, J; none if the body
/// is not rigid.
pub(crate) fn take_out(step: &Step<'_>, body: BodyId) -> Option<f64> {
    let mut bodies = step.resources.try_get_mut::<RigidBodies>()?;
    bodies.of_mut(body).map(|rigid| rigid.take_out(step.clock.dt))
}

struct RigidDrift {
    gravity: DVec3,
}

impl Run for RigidDrift {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let dt = step.clock.dt;
        let constraints = step.ledger.account("constraints", AccountKind::Supplied);
        let gravity_work = step.ledger.account("gravity", AccountKind::Supplied);
        let resources = step.resources;
        for body in resources.get_mut::<RigidBodies>().iter_mut().filter(|body| !body.state.gone) {
            // As for particles: what is prescribed is set first, then the forces kick what is free.
            let before = [body.state.velocity, body.state.angular_velocity];
            let work = body.drive(false, &step.clock)?;
            body.note_drives(before, 0.5 * dt);
            body.kick(0.5 * dt);
            step.ledger.add(constraints, body.id, work - 0.5 * dt * body.constraint_power());
            step.ledger.add(gravity_work, body.id, dt * body.mass * body.state.velocity.dot(self.gravity));
            body.drift(dt);
            place_particles(body, step)?;
        }
        Ok(())
    }
}

/// Puts the particles of a body in their places.
fn place_particles(body: &RigidBody, step: &Step<'_>) -> Result<(), StepError> {
    let (view, rows) = step.world.body_view(body.id);
    let reference = view.read::<ReferencePosition>()?;
    let mut position = view.write::<Position>()?;
    let mut velocity = view.write::<Velocity>()?;
    let rotation = DMat3::from_quat(body.state.rotation);
    let (state, center) = (&body.state, body.reference_center);
    let moved = (&mut position[rows.clone()], &mut velocity[rows.clone()], &reference[rows]);
    type Rows<'a> = (&'a mut [Position], &'a mut [Velocity], &'a [ReferencePosition]);
    sum_over_blocks(moved, &|_, (position, velocity, reference): Rows<'_>| {
        for ((x, v), reference) in position.iter_mut().zip(velocity).zip(reference) {
            let arm = rotation * (reference.0 - center);
            x.0 = state.center + arm;
            v.0 = state.velocity + state.angular_velocity.cross(arm);
        }
    });
    Ok(())
}

/// Share of the spacing by which an acceleration may move a body in a step.
const MOTION_FACTOR: f64 = 0.1;
/// Share of a radian by which a body may turn in a step: the rate of its precession is off by a seventh of
/// the square of that.
const TURN_FACTOR: f64 = 0.02;
/// Step of a body that swings in loads that keep their direction, over one over its frequency: the period is
/// off by a twenty-fourth of the square of that, and above two the swing would grow without bound.
const SWING_FACTOR: f64 = 0.1;
/// Steps of a body that nothing moves, in the whole run.
const MIN_STEPS: f64 = 100.0;

struct RigidKick {
    end: f64,
    followed: FollowedFunctions,
}

impl Run for RigidKick {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let half = 0.5 * step.clock.dt;
        let kinetic = step.ledger.account("kinetic", AccountKind::Stored);
        let constraints = step.ledger.account("constraints", AccountKind::Supplied);
        let resources = step.resources;
        for body in resources.get_mut::<RigidBodies>().iter_mut() {
            if body.state.gone {
                step.ledger.set(kinetic, body.id, 0.0);
                propose(body, DVec3::ZERO, self.end, step);
                continue;
            }
            let contact = sum_of_forces(body, step)?;
            share_out(body, contact, step)?;
            let power = body.constraint_power();
            let middle = body.state.velocity;
            body.kick(half);
            let work = body.drive(true, &step.clock)?;
            step.ledger.add(constraints, body.id, work - half * power);
            let gained = body.state.velocity - middle;
            let driven = if half > 0.0 { gained / half } else { DVec3::ZERO };
            step.ledger.set(kinetic, body.id, body.kinetic());
            let (view, rows) = step.world.body_view(body.id);
            let position = view.read::<Position>()?;
            let mut velocity = view.write::<Velocity>()?;
            let turned = &*body;
            let moved = (&mut velocity[rows.clone()], &position[rows]);
            sum_over_blocks(moved, &|_, (velocity, position): (&mut [Velocity], &[Position])| {
                velocity.iter_mut().zip(position).for_each(|(v, x)| v.0 = turned.velocity_at(x.0));
            });
            if !body.kinetic().is_finite() {
                return Err(step.unstable("velocity is not a finite number", body.id, 0));
            }
            propose(body, driven, self.end, step);
        }
        self.followed.propose(self.end / MIN_STEPS, step);
        Ok(())
    }

    fn save_with(&self, resources: &Resources) -> Vec<u8> {
        let bodies = resources.get::<RigidBodies>();
        let states: Vec<RigidState> = bodies.iter().map(|body| body.state).collect();
        postcard::to_stdvec(&states).unwrap_or_default()
    }

    fn restore_with(&mut self, state: &[u8], resources: &Resources) -> bool {
        let Ok(states) = postcard::from_bytes::<Vec<RigidState>>(state) else { return false };
        let mut bodies = resources.get_mut::<RigidBodies>();
        let fits = states.len() == bodies.len();
        bodies.iter_mut().zip(states).for_each(|(body, state)| body.state = state);
        fits
    }
}

/// Sums the forces on the particles and those of contact into the state of the body; returns the share of
/// contact.
fn sum_of_forces(body: &mut RigidBody, step: &Step<'_>) -> Result<Wrench, StepError> {
    let contact = body.take_contact();
    let (view, rows) = step.world.body_view(body.id);
    let (position, force) = (view.read::<Position>()?, view.read::<Force>()?);
    let center = body.state.center;
    let rows = (&position[rows.clone()], &force[rows]);
    let mut sum = sum_over_blocks(rows, &|_, (position, force): (&[Position], &[Force])| {
        let mut sum = Wrench::default();
        position.iter().zip(force).for_each(|(x, force)| sum.push(x.0 - center, force.0));
        sum
    });
    sum.add(&contact);
    (body.state.force, body.state.torque) = (sum.force, sum.torque);
    Ok(contact)
}

/// Spreads force and torque of contact over the particles as a rigid acceleration, so that sums over the
/// particles are those of the body.
fn share_out(body: &RigidBody, contact: Wrench, step: &Step<'_>) -> Result<(), StepError> {
    if contact == Wrench::default() {
        return Ok(());
    }
    let Wrench { force, torque } = contact;
    let (view, rows) = step.world.body_view(body.id);
    let (position, mass) = (view.read::<Position>()?, view.read::<Mass>()?);
    let mut forces = view.write::<Force>()?;
    let turn = body.state.rotation;
    let spin = body.points.map_or(DVec3::ZERO, |inverse| turn * (inverse * (turn.inverse() * torque)));
    let (center, push) = (body.state.center, force / body.mass);
    let rows = (&mut forces[rows.clone()], &position[rows.clone()], &mass[rows]);
    type Rows<'a> = (&'a mut [Force], &'a [Position], &'a [Mass]);
    sum_over_blocks(rows, &|_, (forces, position, mass): Rows<'_>| {
        for ((f, x), m) in forces.iter_mut().zip(position).zip(mass) {
            f.0 += m.0 * (push + spin.cross(x.0 - center));
        }
    });
    Ok(())
}

/// Proposes the limit of the motion of a body itself, whose velocity changes by `driven`, m/s2, where it is
/// prescribed. Its velocity is no limit: only contacts depend on it, and they have limits of their own.
fn propose(body: &mut RigidBody, driven: DVec3, end: f64, step: &mut Step<'_>) {
    let moments = std::mem::take(&mut body.load_moments);
    let swing = body.swing(moments).sqrt() / SWING_FACTOR;
    let spacing = step.world.body(body.id).spacing;
    let turning = body.state.angular_velocity.length();
    let free = body.constraint.free_axes();
    // Forces do not accelerate a body along axes on which its motion is prescribed.
    let pulled = if free == DVec3::ZERO { DVec3::ZERO } else { free * body.state.force / body.mass };
    let acceleration = (pulled + (DVec3::ONE - free) * driven).length() / spacing;
    let moving = (turning / TURN_FACTOR).max((acceleration / MOTION_FACTOR).sqrt());
    let rate = moving.max(swing).max(MIN_STEPS / end);
    let name = &step.world.body(body.id).name;
    step.limits.propose(1.0 / rate, format_args!("motion of `{name}`"));
}
