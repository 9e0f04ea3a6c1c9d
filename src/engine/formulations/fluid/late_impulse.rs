//! The impulse at the end of a long step that makes up for the change of the frozen force.

use glam::DVec3;

use super::exchange::{CouplingForce, CouplingFriction, CouplingPressure, Exchange};
use super::pair_force::PARTS;
use super::record::Record;
use crate::integrate::constrained;
use crate::parallel::{Split, for_each_block};
use crate::rigid::RigidBody;
use crate::world::{Force, Mass, Mobility, Removed, Velocity};

/// The columns that change.
pub(super) struct ParticleRows<'a> {
    pub velocity: &'a mut [Velocity],
    pub force: &'a mut [Force],
    pub frozen: &'a mut [CouplingForce],
    pub friction: &'a mut [CouplingFriction],
    pub pressure: &'a mut [CouplingPressure],
}

/// The particles of a body at the end of a long step.
pub(super) struct Particles<'a> {
    /// Length of the long step, s; zero before the first.
    pub dt: f64,
    /// The particles as they are now.
    pub records: &'a [Record],
    /// Positions at the start of the long step, m.
    pub before: &'a [DVec3],
    pub mass: &'a [Mass],
    pub mobility: &'a [Mobility],
    pub removed: &'a [Removed],
    /// Force of the flow now, and its parts, N.
    pub total: &'a [Force],
    pub parts: &'a [DVec3],
}

impl Split for ParticleRows<'_> {
    fn rows(&self) -> usize {
        self.velocity.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (velocity, velocity_rest) = self.velocity.split_at_mut(at);
        let (force, force_rest) = self.force.split_at_mut(at);
        let (frozen, frozen_rest) = self.frozen.split_at_mut(at);
        let (friction, friction_rest) = self.friction.split_at_mut(at);
        let (pressure, pressure_rest) = self.pressure.split_at_mut(at);
        (
            Self { velocity, force, frozen, friction, pressure },
            Self {
                velocity: velocity_rest,
                force: force_rest,
                frozen: frozen_rest,
                friction: friction_rest,
                pressure: pressure_rest,
            },
        )
    }
}

impl Particles<'_> {
    /// The force of the flow on particle `i` now, N; none on a removed one.
    fn force_now(&self, i: usize) -> (DVec3, [DVec3; PARTS]) {
        if self.removed[i] != Removed::NO {
            return Default::default();
        }
        (self.total[i].0, std::array::from_fn(|part| self.parts[PARTS * i + part]))
    }

    /// Gives particles that move by themselves their impulses.
    pub fn give(&self, rows: ParticleRows<'_>, sums: &mut Vec<Exchange>) -> Exchange {
        for_each_block(rows, sums, &|first, mut rows: ParticleRows<'_>| {
            let mut sum = Exchange::default();
            for k in 0..rows.rows() {
                let i = first + k;
                let (mass, mobility) = (self.mass[i].0, self.mobility[i].0);
                let change = self.force_now(i).0 - rows.frozen[k].0;
                let before = rows.velocity[k].0;
                let kick = 0.5 * self.dt * (change * mobility);
                sum.kinetic += mass * kick.dot(before + 0.5 * kick);
                sum.constraints -= 0.5 * self.dt * (change * constrained(mobility)).dot(before);
                rows.velocity[k].0 += kick;
                self.take_up(i, k, before + 0.5 * kick, &mut rows, &mut sum);
            }
            sum
        })
    }

    /// Puts the force of now in the place of the frozen one, and books the work of both; `velocity` is the mean of those before and
    /// after the impulse.
    fn take_up(&self, i: usize, k: usize, velocity: DVec3, rows: &mut ParticleRows<'_>, sum: &mut Exchange) {
        let (total, [friction, pressure]) = self.force_now(i);
        let moved = self.before.get(i).map_or(DVec3::ZERO, |before| self.records[i].position() - *before);
        let late = 0.5 * self.dt * velocity;
        sum.parts[0] += rows.friction[k].0.dot(moved) + (friction - rows.friction[k].0).dot(late);
        sum.parts[1] += rows.pressure[k].0.dot(moved) + (pressure - rows.pressure[k].0).dot(late);
        if self.removed[i] == Removed::NO {
            rows.force[k].0 += total - rows.frozen[k].0;
        }
        rows.frozen[k] = CouplingForce(total);
        rows.friction[k] = CouplingFriction(friction);
        rows.pressure[k] = CouplingPressure(pressure);
    }
}

/// Gives a rigid body the impulses of its particles, and takes these along.
pub(super) fn give_to_rigid_body(
    body: &mut RigidBody,
    particles: &Particles<'_>,
    mut rows: ParticleRows<'_>,
) -> Exchange {
    let (mut force, mut torque) = (DVec3::ZERO, DVec3::ZERO);
    for (i, frozen) in rows.frozen.iter().enumerate() {
        let change = particles.force_now(i).0 - frozen.0;
        force += change;
        torque += (particles.records[i].position() - body.state.center).cross(change);
    }
    let (kinetic, constraints) = body.push_late(force, torque, 0.5 * particles.dt);
    let mut sum = Exchange { kinetic, constraints, ..Exchange::default() };
    for i in 0..rows.rows() {
        let before = rows.velocity[i].0;
        let after = body.velocity_at(particles.records[i].position());
        rows.velocity[i].0 = after;
        particles.take_up(i, i, 0.5 * (before + after), &mut rows, &mut sum);
    }
    sum
}
