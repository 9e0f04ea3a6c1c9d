//! Prescribed motion: the velocity of constrained axes at mid-step and at the end of the step.
//!
//! The drift moves a particle by dt v(n+1/2), so that the velocity at mid-step determines its path. Outputs,
//! damping and viscosity use the velocity at the end of the step. The change of kinetic energy by the
//! condition is the work of the constraint.

use std::sync::Arc;

use glam::DVec3;

use super::driven_fluids;
use super::field::VectorField;
use super::part::{Part, parts_of, phases_of};
use super::pulses;
use super::rigid_part::{require_one_motion, split_rigid};
use crate::parallel::{Picked, sum_over_blocks};
use crate::plugin::{BodyKind, MotionOfPlace, Prescription, Selection, SetupError, SimBuilder};
use crate::rigid::{Drive, DrivenBody, MovingFunction};
use crate::scene::Expression;
use crate::schedule::{AccountKind, Clock, Mode, Run, Stage, Step, StepError, System};
use crate::world::{Column, Mass, Position, Removed, Velocity};

/// How the value of a condition gives the velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PrescribedKind {
    /// The value is the velocity.
    Velocity,
    /// The value is the displacement from the reference position.
    Displacement,
}

/// A prescribed motion of some particles.
struct PrescribedMotion {
    name: &'static str,
    kind: PrescribedKind,
    field: VectorField,
    parts: Vec<Part>,
    /// Step of the difference that gives the velocity at the start, s.
    time_increment: f64,
}

/// Adds the systems that move the selection.
pub(super) fn prescribe(
    name: &'static str,
    kind: PrescribedKind,
    field: VectorField,
    selection: &Selection,
    sim: &mut SimBuilder<'_>,
) -> Result<(), SetupError> {
    sim.carry(selection, field.axes());
    let (selection, rigid) = split_rigid(selection, sim)?;
    let time_increment = 1e-6 * sim.scene().time.end;
    for body in rigid {
        require_one_motion(name, &field, body, sim)?;
        let motion = PrescribedMotion { name, kind, field: field.clone(), parts: Vec::new(), time_increment };
        let stated = prescription(&motion);
        let place = sim.body(body).sites.first().map_or(DVec3::ZERO, |site| site.position);
        field.functions().for_each(|value| sim.extend(MovingFunction { body, value: value.clone(), place }));
        sim.extend(DrivenBody { body, motion: stated, axes: field.axes(), drive: Box::new(motion) });
    }
    if selection.is_empty() {
        return Ok(());
    }
    driven_fluids::warn(name, &selection, sim);
    let parts = parts_of(&selection, sim);
    let functions: Vec<Expression> = field.functions().cloned().collect();
    pulses::watch(name, &functions, pulses::places_of(&parts), sim);
    let motion = PrescribedMotion { name, kind, field, parts, time_increment };
    sim.prescribe(&selection, motion.field.axes(), prescription(&motion))?;
    let motion = Arc::new(motion);
    start_walls(&motion, sim);
    let phases = phases_of(&selection, sim);
    let label = name.to_lowercase();
    let at_middle = SetVelocity { motion: Arc::clone(&motion), end_of_step: false, values: Vec::new() };
    let at_end = SetVelocity { motion, end_of_step: true, values: Vec::new() };
    // After the kick, which writes velocities. Two conditions hold one axis of one particle only where their
    // values agree, so their order does not matter: `Adds` says so.
    sim.add_system(
        System::new(Stage::PreStep, label.clone(), at_middle)
            .on_phases(phases.clone())
            .reads::<Position>()
            .reads::<Mass>()
            .reads::<Removed>()
            .touches(Velocity::NAME, Mode::Adds)
            .by_body(),
    );
    sim.add_system(
        System::new(Stage::FinalIntegrate, label, at_end)
            .on_phases(phases)
            .reads::<Mass>()
            .reads::<Removed>()
            .touches(Velocity::NAME, Mode::Adds)
            .by_body(),
    );
    Ok(())
}

/// The prescription of a motion, for other conditions on the same particles.
fn prescription(motion: &PrescribedMotion) -> Prescription {
    let field = motion.field.clone();
    let value: MotionOfPlace = Arc::new(move |point, t| field.at(point, t));
    match motion.kind {
        PrescribedKind::Velocity => Prescription::velocity(motion.name, value),
        PrescribedKind::Displacement => Prescription::displacement(motion.name, value),
    }
}

/// Gives walls their velocity before the first force is computed: friction with a wall that seems to be at
/// rest would kick a fluid that moves with it.
fn start_walls(motion: &Arc<PrescribedMotion>, sim: &mut SimBuilder<'_>) {
    let is_wall = |part: &&Part| sim.body(part.body).kind == BodyKind::Boundary;
    let walls: Vec<Part> = motion.parts.iter().filter(is_wall).cloned().collect();
    if walls.is_empty() {
        return;
    }
    let motion = Arc::clone(motion);
    sim.add_setup(move |setup| {
        let axes = motion.field.axes();
        for part in &walls {
            let (view, _) = setup.world.body_view(part.body);
            let mut velocity = view.write::<Velocity>().map_err(|error| SetupError::internal(&error))?;
            for (&row, &point) in part.rows.iter().zip(&part.points) {
                let value = motion.velocity_at_start(point);
                // What is no number is an error in the first step.
                for axis in (0..3).filter(|&axis| axes[axis] && value.is_finite()) {
                    velocity[row as usize].0[axis] = value[axis];
                }
            }
        }
        Ok(())
    });
}

impl Drive for PrescribedMotion {
    fn velocity(
        &self,
        end_of_step: bool,
        clock: &Clock,
        center: DVec3,
        reference: DVec3,
    ) -> Result<DVec3, StepError> {
        let mut value = Vec::with_capacity(1);
        let mut at = |t: f64| self.field.values(&[reference], t, self.name, &mut value).map(|()| value[0]);
        match (self.kind, end_of_step) {
            (PrescribedKind::Velocity, false) => at(clock.middle()),
            (PrescribedKind::Velocity, true) => at(clock.end()),
            (PrescribedKind::Displacement, false) => Ok((reference + at(clock.end())? - center) / clock.dt),
            (PrescribedKind::Displacement, true) => {
                let (before, after) = self.around_end(clock);
                Ok((at(after)? - at(before)?) / (after - before))
            }
        }
    }
}

impl PrescribedMotion {
    /// Velocity of a particle at the start, m/s.
    fn velocity_at_start(&self, point: DVec3) -> DVec3 {
        match self.kind {
            PrescribedKind::Velocity => self.field.at(point, 0.0),
            PrescribedKind::Displacement => {
                let after = self.time_increment;
                (self.field.at(point, after) - self.field.at(point, 0.0)) / after
            }
        }
    }

    /// Two times, s, whose difference gives the velocity at the end of the step.
    fn around_end(&self, clock: &Clock) -> (f64, f64) {
        let half = if clock.dt > 0.0 { 0.5 * clock.dt } else { self.time_increment };
        ((clock.end() - half).max(0.0), clock.end() + half)
    }

    /// Velocity of every particle of a part: at mid-step, or at the end of the step.
    fn velocities(
        &self,
        part: &Part,
        end_of_step: bool,
        step: &Step<'_>,
        out: &mut Vec<DVec3>,
    ) -> Result<(), StepError> {
        let clock = step.clock;
        match (self.kind, end_of_step) {
            (PrescribedKind::Velocity, false) => {
                self.field.values(&part.points, clock.middle(), self.name, out)
            }
            (PrescribedKind::Velocity, true) => self.field.values(&part.points, clock.end(), self.name, out),
            (PrescribedKind::Displacement, false) => {
                self.field.values(&part.points, clock.end(), self.name, out)?;
                let (view, _) = step.world.body_view(part.body);
                let position = view.read::<Position>()?;
                let position = &position[..];
                let rows = (&mut out[..], &part.rows[..], &part.points[..]);
                type Rows<'a> = (&'a mut [DVec3], &'a [u32], &'a [DVec3]);
                sum_over_blocks(rows, &|_, (out, rows, points): Rows<'_>| {
                    for ((value, &row), &point) in out.iter_mut().zip(rows).zip(points) {
                        // From where the particle is, so that rounding does not add up over the steps.
                        *value = (point + *value - position[row as usize].0) / clock.dt;
                    }
                });
                Ok(())
            }
            (PrescribedKind::Displacement, true) => {
                let (before, after) = self.around_end(&clock);
                self.field.values(&part.points, after, self.name, out)?;
                let rows = (&mut out[..], &part.points[..]);
                sum_over_blocks(rows, &|_, (out, points): (&mut [DVec3], &[DVec3])| {
                    for (value, &point) in out.iter_mut().zip(points) {
                        *value = (*value - self.field.at(point, before)) / (after - before);
                    }
                });
                Ok(())
            }
        }
    }
}

struct SetVelocity {
    motion: Arc<PrescribedMotion>,
    end_of_step: bool,
    values: Vec<DVec3>,
}

impl Run for SetVelocity {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let constraints = step.ledger.account("constraints", AccountKind::Supplied);
        let kinetic = step.ledger.account("kinetic", AccountKind::Stored);
        let axes = self.motion.field.axes();
        for part in &self.motion.parts {
            if !step.part.is_due(step.world, part.body) {
                continue;
            }
            self.motion.velocities(part, self.end_of_step, step, &mut self.values)?;
            let (view, _) = step.world.body_view(part.body);
            let mass = view.read::<Mass>()?;
            let removed = view.read::<Removed>()?;
            let mut velocity = view.write::<Velocity>()?;
            let (mass, removed) = (&mass[..], &removed[..]);
            let rows = (Picked::new(&part.rows, &mut velocity), &self.values[..]);
            let gain = sum_over_blocks(rows, &|_, (mut moved, values): (Picked<'_, Velocity>, &[DVec3])| {
                let mut gain = 0.0;
                for (k, value) in values.iter().enumerate() {
                    let row = moved.number(k);
                    if removed[row] != Removed::NO {
                        continue;
                    }
                    let v = &mut moved.row(k).0;
                    let before = v.length_squared();
                    for axis in (0..3).filter(|&axis| axes[axis]) {
                        v[axis] = value[axis];
                    }
                    gain += 0.5 * mass[row].0 * (v.length_squared() - before);
                }
                gain
            });
            step.ledger.add(constraints, part.body, gain);
            if self.end_of_step {
                // The kick has taken the kinetic energy with the velocity at mid-step.
                step.ledger.add(kinetic, part.body, gain);
            }
        }
        Ok(())
    }
}
