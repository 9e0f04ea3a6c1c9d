//! Second pass over pairs: the force of stress and hourglass control on every particle, with gravity.

use glam::DVec3;

use super::control::ControlForce;
use super::phase::UpdatedRows;
use crate::formulations::total_lagrangian::InternalForce as StressForce;
use crate::parallel::{for_each_block, run_hot_in};
use crate::schedule::{Run, Step, StepError};
use crate::world::{Force, Mass, PhaseId};

/// The system of the pass.
pub(super) struct InternalForce {
    pub phase: PhaseId,
    /// Plane strain.
    pub plane: bool,
    /// Acceleration of gravity, m/s2.
    pub gravity: DVec3,
}

impl Run for InternalForce {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let rows = step.resources.solid_rows::<UpdatedRows>(self.phase);
        let mass = view.read::<Mass>()?;
        let mut force = view.write::<Force>()?;
        write(&rows, &mass, self.gravity, self.plane, &mut force);
        Ok(())
    }
}

/// Writes the force of the last first pass, N.
pub(super) fn write(rows: &UpdatedRows, mass: &[Mass], gravity: DVec3, plane: bool, force: &mut [Force]) {
    let UpdatedRows {
        bonds,
        ghosts,
        cracks,
        sites,
        originals,
        stresses,
        control,
        control_bonds,
        hessian,
        self_force,
        frames,
        ..
    } = rows;
    let mass = bytemuck::cast_slice(mass);
    StressForce { bonds, ghosts, cracks, sites, stresses, self_force, frames, mass, gravity, plane }
        .run(force);
    hessian.add_vidal_force(bonds, sites, force);
    if rows.has_control {
        for_each_block(force, &mut Vec::new(), &|first, force: &mut [Force]| {
            run_hot_in(
                plane,
                ControlForce {
                    bonds: control_bonds,
                    pull: &hessian.pull,
                    sites: originals,
                    control,
                    first,
                    force,
                },
            );
        });
    }
}
