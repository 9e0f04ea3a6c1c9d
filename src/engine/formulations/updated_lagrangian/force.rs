//! Second pass over pairs: the force of stress and hourglass control on every particle, with gravity.

use glam::DVec3;

use super::control::Control;
use super::force_change::ForceChange;
use super::phase::UpdatedRows;
use crate::formulations::bonded::{InternalForce as StressForce, bodies_of};
use crate::parallel::{for_each_block, share_rows_of};
use crate::schedule::{Run, Shared, Step, StepError};
use crate::world::{Force, Mass, PhaseId};

/// The system of the pass.
pub(super) struct UpdatedForce {
    pub phase: PhaseId,
    /// Plane strain.
    pub plane: bool,
    /// Acceleration of gravity, m/s2.
    pub gravity: DVec3,
    pub change: Shared<ForceChange>,
}

impl Run for UpdatedForce {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let rows = step.resources.solid_rows::<UpdatedRows>(self.phase);
        let mass = view.read::<Mass>()?;
        let mut force = view.write_own::<Force>()?;
        if rows.has_force {
            add_gravity(&rows, &mass, self.gravity, &mut force);
        } else {
            write_own(&rows, &mass, self.gravity, self.plane, &mut force);
            step.resources.of(self.change).take_back(&mut force);
        }
        Ok(())
    }
}

/// Writes the force that is known for a step with an update, N, with gravity.
fn add_gravity(rows: &UpdatedRows, mass: &[Mass], gravity: DVec3, force: &mut [Force]) {
    let UpdatedRows { force: known, sites, .. } = rows;
    for_each_block(force, &mut Vec::new(), &|first, force: &mut [Force]| {
        for (force, row) in force.iter_mut().zip(first..) {
            let weight = if sites[row].is_present() { gravity * mass[row].0 } else { DVec3::ZERO };
            *force = Force(known[row].0 + weight);
        }
    });
}

/// Writes the force of the last first pass on the particles of all ranks, N, without gravity.
pub(super) fn write(rows: &UpdatedRows, mass: &[Mass], plane: bool, force: &mut [Force]) {
    write_own(rows, mass, DVec3::ZERO, plane, force);
    share_rows_of(force, bodies_of(&rows.frames));
}

/// Writes the force of the last first pass on the particles that this rank computes, N.
fn write_own(rows: &UpdatedRows, mass: &[Mass], gravity: DVec3, plane: bool, force: &mut [Force]) {
    let UpdatedRows { bonds, ghosts, cracks, sites, stresses, control, hessian, self_force, frames, .. } =
        rows;
    let mass = bytemuck::cast_slice(mass);
    let of_stress =
        StressForce { bonds, ghosts, cracks, sites, stresses, self_force, frames, mass, gravity, plane };
    of_stress.write_own(force);
    hessian.add_vidal_force(bonds, sites, force);
    if !control.has_sums() {
        return;
    }
    let Control { is_apart, bonds, sites, stresses, self_force, frames, .. } = control;
    let of_control =
        StressForce { bonds, sites, stresses, self_force, frames, gravity: DVec3::ZERO, ..of_stress };
    for (rows, is_apart) in bodies_of(frames).zip(is_apart) {
        if *is_apart {
            of_control.add_to_own(rows, force);
        }
    }
}
