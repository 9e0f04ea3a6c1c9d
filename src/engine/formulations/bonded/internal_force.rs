//! Second pass over pairs: the force of stress and folded terms on every particle.
//!
//! `f_i = V_i sum_j V_j w_ij [(A_i + A_j) X_ij + (k_i + k_j) u_ij]` (see [`CorrectedStress`]): swapping i and
//! j changes the sign of the bracket, so that momentum is conserved to round-off. The sum is taken as
//!
//! ```text
//! A_i sum_j V_j w_ij X_ij + k_i sum_j V_j w_ij u_ij          known from the first pass
//!   + sum_j V_j w_ij q_j - (sum_j V_j w_ij A_j) X_i - (sum_j V_j w_ij k_j) u_i,      q_j = A_j X_j + k_j u_j
//! ```
//!
//! with A and u in the [`AffineFrame`] of the body, so that a neighbour costs four products with the values
//! of its record, and no quantity depends on both particles.

use std::ops::Range;

use glam::DVec3;

use super::bond_sum::{BondSum, SumOverBonds};
use super::bonds::Bonds;
use super::cracks::Cracks;
use super::frame::{AffineFrame, bodies_of, frame_of};
use super::rows::PackedParticle;
use crate::parallel::{FourLanes, PlaneOrSpace, for_each_own_block, run_hot_in, share_rows_of};
use crate::solids::CorrectedStress;
use crate::symmetry::Ghosts;
use crate::world::Force;

/// The pass over all bodies of the phase.
pub(in crate::formulations) struct InternalForce<'a> {
    pub bonds: &'a Bonds,
    pub ghosts: &'a Ghosts,
    pub cracks: &'a Cracks,
    pub sites: &'a [PackedParticle],
    pub stresses: &'a [CorrectedStress],
    pub self_force: &'a [DVec3],
    /// Of every body.
    pub frames: &'a [AffineFrame],
    /// Mass of every particle, kg.
    pub mass: &'a [f64],
    /// Acceleration of gravity, m/s2.
    pub gravity: DVec3,
    /// Plane strain.
    pub plane: bool,
}

impl<'a> InternalForce<'a> {
    /// Adds the force on the rows of a body that this rank computes, N.
    pub fn add_to_own(&self, rows: Range<usize>, force: &mut [Force]) {
        let start = rows.start;
        for_each_own_block(&mut force[rows], &mut Vec::new(), &|first, force: &mut [Force]| {
            run_hot_in(self.plane, InternalForceRows { pass: self, first: start + first, force, adds: true });
        });
    }

    /// Writes the force on the particles that this rank computes: gravity plus internal force, N.
    pub fn write_own(&self, force: &mut [Force]) {
        for body in bodies_of(self.frames) {
            let start = body.start;
            for_each_own_block(&mut force[body], &mut Vec::new(), &|first, force: &mut [Force]| {
                let first = start + first;
                run_hot_in(
                    self.plane,
                    InternalForceRows { pass: self, first, force: &mut *force, adds: false },
                );
                let Self { bonds, ghosts, cracks, sites, .. } = *self;
                for &row in cracks.rows_of_block(first, force.len()) {
                    let row = row as usize;
                    force[row - first].0 -= cracks.force_across(row, bonds, ghosts, sites);
                }
            });
        }
    }

    /// Gives all ranks the force on every particle.
    pub fn share(&self, force: &mut [Force]) {
        share_rows_of(force, bodies_of(self.frames));
    }
}

struct InternalForceRows<'a> {
    pass: &'a InternalForce<'a>,
    first: usize,
    force: &'a mut [Force],
    /// Whether to add to the present values.
    adds: bool,
}

impl PlaneOrSpace for InternalForceRows<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let InternalForce { bonds, sites, stresses, self_force, frames, mass, gravity, .. } = *self.pass;
        let mut frame = frame_of(frames, self.first);
        for (k, force) in self.force.iter_mut().enumerate() {
            let i = self.first + k;
            let site = sites[i];
            let sum = BondSum::<D>::over(a, bonds, stresses, i);
            if frames[frame].end <= i {
                frame = frame_of(frames, i);
            }
            let rest = frames[frame].rest_in(a, &site);
            let mut traction = a.scale_add(-sum.columns[0].0[3], rest, sum.traction);
            for axis in 0..D {
                traction = a.scale_add(-site.reference.0[axis], sum.columns[axis], traction);
            }
            let volume = site.reference.0[3];
            // A removed particle has no volume here: nothing acts on it, not even gravity.
            let weight = if site.is_present() { gravity * mass[i] } else { DVec3::ZERO };
            let total = (traction.xyz() + self_force[i]) * volume + weight;
            *force = Force(if self.adds { force.0 + total } else { total });
        }
    }
}
