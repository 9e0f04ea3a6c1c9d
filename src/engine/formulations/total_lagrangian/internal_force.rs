//! Second pass over pairs: the force of stress and bond terms on every particle.
//!
//! `f_i = V_i sum_j V_j w_ij [(A_i + A_j) X_ij + (k_i + k_j) u_ij]` (see [`PairStress`]): swapping i and j turns the sign
//! of every product, so momentum is kept to round-off.

use glam::DVec3;

use super::bonds::Bonds;
use super::formulation::PackedRows;
use super::rows::{PairStress, Site};
use crate::parallel::{Arithmetic, Lanes4, PlaneOrSolid, for_each_block, run_hot_in};
use crate::schedule::{Step, StepError};
use crate::world::{Force, Mass, PhaseId};

/// The pass over all bodies of the phase.
pub(super) struct InternalForce<'a> {
    pub bonds: &'a Bonds,
    pub sites: &'a [Site],
    pub pair_stress: &'a [PairStress],
    /// Mass of every particle, kg.
    pub mass: &'a [f64],
    /// Acceleration of gravity, m/s2.
    pub gravity: DVec3,
    /// Plane strain.
    pub plane: bool,
}

impl InternalForce<'_> {
    /// Writes the force on every particle: gravity plus internal force, N.
    pub fn run(&self, force: &mut [Force]) {
        for_each_block(force, &mut Vec::new(), &|first, force: &mut [Force]| {
            run_hot_in(self.plane, ForceRows { pass: self, first, force });
        });
    }
}

struct ForceRows<'a> {
    pass: &'a InternalForce<'a>,
    first: usize,
    force: &'a mut [Force],
}

impl PlaneOrSolid for ForceRows<'_> {
    #[inline(always)]
    fn run<A: Arithmetic, const D: usize>(self, a: A) {
        let InternalForce { bonds, sites, pair_stress, mass, gravity, .. } = *self.pass;
        for (k, force) in self.force.iter_mut().enumerate() {
            let i = self.first + k;
            let site = sites[i];
            let own = pair_stress[i];
            let row = bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize;
            let mut sum = Lanes4::ZERO;
            for (&j, &weight) in bonds.neighbors[row.clone()].iter().zip(&bonds.weights[row]) {
                let other = &sites[j as usize];
                let stress = &pair_stress[j as usize];
                let reference = a.minus(other.reference, site.reference);
                let displacement = a.minus(other.displacement, site.displacement);
                let mut pull = a.scale(own.stiffness() + stress.stiffness(), displacement);
                for axis in 0..D {
                    let column = a.plus(own.0[axis], stress.0[axis]);
                    pull = a.scale_add(reference.0[axis], column, pull);
                }
                sum = a.scale_add(f64::from(weight) * other.reference.0[3], pull, sum);
            }
            let volume = site.reference.0[3];
            // A removed particle has no volume here: nothing acts on it, not even gravity.
            let weight = if site.is_present() { gravity * mass[i] } else { DVec3::ZERO };
            *force = Force(sum.xyz() * volume + weight);
        }
    }
}

/// The system of the pass.
pub(super) fn run(step: &mut Step<'_>, phase: PhaseId, gravity: DVec3, plane: bool) -> Result<(), StepError> {
    let view = step.world.phase(phase);
    let packed = step.resources.get::<PackedRows>();
    let mass = view.read::<Mass>()?;
    let mut force = view.write::<Force>()?;
    let pass = InternalForce {
        bonds: &packed.bonds,
        sites: &packed.sites,
        pair_stress: &packed.pair_stress,
        mass: bytemuck::cast_slice(&mass),
        gravity,
        plane,
    };
    pass.run(&mut force);
    Ok(())
}
