//! The impulse at the end of a long step that makes up for the change of the frozen force.

use glam::DVec3;

use super::drag::DragRows;
use super::exchange::{CouplingForce, CouplingFriction, CouplingPressure, Exchange};
use crate::formulations::fluid::cloud::PARTS;
use crate::formulations::fluid::lanes::FlowParticle;
use crate::integrate::constrained;
use crate::parallel::{Split, for_each_block, split_by_rows};
use crate::rigid::RigidBody;
use crate::world::{Force, Mass, Mobility, Removed, Velocity};

/// Friction at the surface of a row of particles pulls at it with 1.6 times its force, and at the row below
/// with -0.6 (`moments::friction`), and follows their velocities alike. The fluid beside, of the same
/// density, follows at its own rate: the fastest motion of both together decays at 3.7 times the rate that
/// the force on the first row alone has, and explicit steps stand two over the rate.
const SHARED: f64 = 2.0;

/// The columns that change.
pub struct ParticleRows<'a> {
    pub velocity: &'a mut [Velocity],
    pub force: &'a mut [Force],
    pub frozen: &'a mut [CouplingForce],
    pub friction: &'a mut [CouplingFriction],
    pub pressure: &'a mut [CouplingPressure],
    /// Friction that follows the motion within the long step; none where friction does not.
    pub drag: Option<DragRows<'a>>,
}

/// The particles of a body at the end of a long step.
pub struct Particles<'a> {
    /// Length of the long step, s; zero before the first.
    pub dt: f64,
    /// Whether it has several sub-steps.
    pub divided: bool,
    /// The particles in their current state.
    pub records: &'a [FlowParticle],
    /// Positions at the start of the long step, m.
    pub before: &'a [DVec3],
    pub mass: &'a [Mass],
    pub mobility: &'a [Mobility],
    pub removed: &'a [Removed],
    /// How fast friction grows with the velocity, kg/s.
    pub drag: &'a [f64],
    /// Force of the flow now, and its parts, N.
    pub total: &'a [Force],
    pub parts: &'a [DVec3],
}

split_by_rows!(ParticleRows { velocity, force, frozen, friction, pressure, drag });

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
                let late = self.correction_impulse(i, k, &rows);
                let before = rows.velocity[k].0;
                let kick = late * mobility;
                sum.kinetic += mass * kick.dot(before + 0.5 * kick);
                sum.constraints -= (late * constrained(mobility)).dot(before);
                rows.velocity[k].0 += kick;
                self.replace_force(i, k, before + 0.5 * kick, &mut rows, &mut sum);
            }
            sum
        })
    }

    /// Bound of the fastest rate at which friction slows a particle of a body that deforms, 1/s, so that
    /// steps of one over it are stable.
    pub fn rate(&self) -> f64 {
        let moves = |k: usize| self.removed[k] == Removed::NO && self.mobility[k].0 != DVec3::ZERO;
        let rates = self.drag.iter().zip(self.mass).enumerate();
        rates.filter(|(k, _)| moves(*k)).map(|(_, (drag, mass))| SHARED * drag / mass.0).fold(0.0, f64::max)
    }

    /// Minimum density of a particle of the body that the flow acts on, kg/m3.
    pub fn lightest(&self) -> Option<f64> {
        let rows = self.records.iter().zip(self.mass).zip(self.total);
        let wet = rows.filter(|((record, _), force)| record.volume() > 0.0 && force.0 != DVec3::ZERO);
        wet.map(|((record, mass), _)| mass.0 / record.volume()).min_by(f64::total_cmp)
    }

    /// [`Particles::rate`] of a rigid body: the sum of the rates of all of its motions, which is no less than
    /// the fastest.
    pub fn rate_of_rigid_body(&self, body: &RigidBody) -> f64 {
        let along = |x: DVec3| -> f64 { DVec3::AXES.iter().map(|&axis| body.inverse_mass_at(x, axis)).sum() };
        let pulled = self.drag.iter().zip(self.records).filter(|(drag, _)| **drag > 0.0);
        pulled.map(|(drag, record)| drag * along(record.position())).sum()
    }

    /// The missing impulse of particle `i` up to dt/2 (f(n) + f(n+1)), N s.
    fn correction_impulse(&self, i: usize, k: usize, rows: &ParticleRows<'_>) -> DVec3 {
        let given = rows.drag.as_ref().map_or(DVec3::ZERO, |drag| drag.impulse(k));
        0.5 * self.dt * (self.force_now(i).0 - rows.frozen[k].0) - given
    }

    /// The change of the force that the next kick of particle `i` spends, N.
    fn change(&self, i: usize, k: usize, rows: &ParticleRows<'_>) -> DVec3 {
        let rest = rows.drag.as_ref().map_or(DVec3::ZERO, |drag| drag.rest(k));
        self.force_now(i).0 - rows.frozen[k].0 - rest
    }

    /// Puts the force of now in the place of the frozen one, and books the work of both; `velocity` is the
    /// mean of those before and after the impulse.
    fn replace_force(
        &self,
        i: usize,
        k: usize,
        velocity: DVec3,
        rows: &mut ParticleRows<'_>,
        sum: &mut Exchange,
    ) {
        let (total, [friction, pressure]) = self.force_now(i);
        let moved = self.before.get(i).map_or(DVec3::ZERO, |before| self.records[i].position() - *before);
        let late = if self.removed[i] == Removed::NO {
            0.5 * self.dt * velocity
        } else {
            // What has gone in this step took the frozen force in all of it along, the fluid in its half.
            sum.removed -= 0.5 * rows.frozen[k].0.dot(moved);
            0.5 * moved
        };
        // In a step that is not divided the change is as long as the step: what the pressure moves to and fro
        // in two of them has no velocity here. Friction, which depends on the velocity, leaves none of that.
        let pressed = if self.divided { late } else { 0.5 * moved };
        let change = self.change(i, k, rows);
        if let Some(drag) = &mut rows.drag {
            let moving = if self.dt > 0.0 { moved / self.dt } else { velocity };
            let given = drag.impulse(k);
            let drag_now = if self.removed[i] == Removed::NO { self.drag[i] } else { 0.0 };
            sum.parts[0] += drag.begin(k, drag_now, moving) - given.dot(velocity);
        }
        sum.parts[0] += rows.friction[k].0.dot(moved) + (friction - rows.friction[k].0).dot(late);
        sum.parts[1] += rows.pressure[k].0.dot(moved) + (pressure - rows.pressure[k].0).dot(pressed);
        if self.removed[i] == Removed::NO {
            rows.force[k].0 += change;
        }
        rows.frozen[k] = CouplingForce(total);
        rows.friction[k] = CouplingFriction(friction);
        rows.pressure[k] = CouplingPressure(pressure);
    }
}

/// Gives a rigid body the impulses of its particles, and takes these along.
pub fn give_to_rigid_body(
    body: &mut RigidBody,
    particles: &Particles<'_>,
    mut rows: ParticleRows<'_>,
) -> Exchange {
    let half = 0.5 * particles.dt;
    let (mut push, mut change) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2]);
    for i in 0..rows.rows() {
        let lever = particles.records[i].position() - body.state.center;
        let late = if half > 0.0 { particles.correction_impulse(i, i, &rows) / half } else { DVec3::ZERO };
        let next = particles.change(i, i, &rows);
        push = [push[0] + late, push[1] + lever.cross(late)];
        change = [change[0] + next, change[1] + lever.cross(next)];
    }
    let (kinetic, constraints) = body.correct(push, change, half);
    let mut sum = Exchange { kinetic, constraints, ..Exchange::default() };
    for i in 0..rows.rows() {
        let before = rows.velocity[i].0;
        let after = body.velocity_at(particles.records[i].position());
        rows.velocity[i].0 = after;
        particles.replace_force(i, i, 0.5 * (before + after), &mut rows, &mut sum);
    }
    sum
}
