//! The system of the internal force.

use glam::DVec3;

use super::phase::PackedRows;
use crate::formulations::bonded::InternalForce;
use crate::schedule::{Step, StepError};
use crate::world::{Force, Mass, PhaseId};

impl<'a> InternalForce<'a> {
    /// The pass over the results of the first one.
    pub fn of(packed: &'a PackedRows, mass: &'a [Mass], gravity: DVec3, plane: bool) -> Self {
        let PackedRows { bonds, ghosts, cracks, sites, stresses, self_force, frames, .. } = packed;
        let mass = bytemuck::cast_slice(mass);
        Self { bonds, ghosts, cracks, sites, stresses, self_force, frames, mass, gravity, plane }
    }
}

/// The system of the pass.
pub(in crate::formulations) fn run(
    step: &mut Step<'_>,
    phase: PhaseId,
    gravity: DVec3,
    plane: bool,
) -> Result<(), StepError> {
    let view = step.world.phase(phase);
    let packed = step.resources.solid_rows::<PackedRows>(phase);
    let mass = view.read::<Mass>()?;
    let mut force = view.write_own::<Force>()?;
    InternalForce::of(&packed, &mass, gravity, plane).write_own(&mut force);
    packed.hessian.add_vidal_force(&packed.bonds, &packed.sites, &mut force);
    Ok(())
}
