//! Stabilizers of bodies whose reference has been updated: from the original pair vectors X_ij, with weights
//! of the reference.
//!
//! ```text
//! H_i = (sum_j V_j w_ij u_ij (x) X_ij) (sum_j V_j w_ij X_ij (x) X_ij)^-1 ,   u_ij = x_ij - X_ij
//! force_i = V_i sum_j V_j w_ij [(B_i + B_j) X_ij + (k_i + k_j) u_ij]
//! ```
//!
//! Folded terms compute B and k from H and from the residual `sum_j V_j w_ij |H_i X_ij - u_ij|^2`. H_i is the
//! fit that minimizes the residual. Between updates the force of a variational term is therefore the exact
//! gradient of its energy, without torque on a body in rigid motion. With increments measured from the last
//! update, every update would erase the residual that the control resists.
//!
//! The weight is evaluated at the distance `|(F_r,i + F_r,j) X_ij| / 2`, which follows from the deformation
//! alone, and not at the distance of the particles. The latter contains the hourglass motion: at the next
//! update a pair that has come too close would get a larger weight, and with it energy without work (two
//! colliding rubber rings, updates every three steps: 18 J of 36 J).
//!
//! Failed particles are in no sum.
//!
//! Before the first update these sums equal those of the stress: the terms are then folded into the stress,
//! as in a total-Lagrangian body.

use std::ops::Range;

use glam::{DMat3, DVec3};

use crate::formulations::bonded::{
    AffineFrame, Bonds, CompleteStress, Gather, HessianBlock, PackedParticle, Written, fill_ghosts,
};
use crate::linalg::Sym3;
use crate::parallel::{BLOCK, run_hot, run_hot_in};
use crate::solids::{Constitutive, CorrectedStress, SolidBlock, SolidRows, SolidSum};
use crate::symmetry::Ghosts;

/// The packed rows of the stabilizers; without a body of its own, empty.
#[derive(Default)]
pub(super) struct Control {
    /// Of every body: whether stabilizers act on it that are folded terms, or differences of Laplacians.
    pub is_stabilized: Vec<bool>,
    /// Of every body: whether its stabilizers have sums of their own.
    pub is_apart: Vec<bool>,
    /// The bonds of the reference with other weights, and moments of the original pair vectors.
    pub bonds: Bonds,
    /// Where original positions are measured from, m.
    pub origin: DVec3,
    /// Volume V of what holds, m3; zero of all else.
    pub volume: Vec<f64>,
    /// Original position with the volume V where the particle holds, and displacement since the start.
    pub sites: Vec<PackedParticle>,
    /// B and k.
    pub stresses: Vec<CorrectedStress>,
    /// The part of the force on each particle that comes from its own B and k, over its volume.
    pub self_force: Vec<DVec3>,
    pub frames: Vec<AffineFrame>,
}

impl Control {
    /// Those of bodies of which some are stabilized.
    pub fn of(is_stabilized: Vec<bool>) -> Self {
        Self { is_stabilized, ..Self::default() }
    }

    /// Whether any body has sums for its stabilizers.
    pub fn has_sums(&self) -> bool {
        self.is_apart.contains(&true)
    }

    /// Copies stresses to the ghosts, with the force along its bonds of every row.
    pub fn fill_ghost_stresses(&mut self, ghosts: &Ghosts, bond_force: impl Fn(usize) -> DVec3 + Sync) {
        if self.has_sums() {
            fill_ghosts(ghosts, &self.frames, &self.sites, &mut self.stresses, bond_force);
        }
    }
}

/// The sums of the stabilizers of one body.
pub(super) struct ControlPass<'a> {
    pub bonds: &'a Bonds,
    pub sites: &'a [PackedParticle],
    pub frame: AffineFrame,
    /// Plane strain.
    pub plane: bool,
}

/// Rows that the pass writes of a block.
pub(super) struct ControlRows<'a> {
    pub stresses: &'a mut [CorrectedStress],
    pub self_force: &'a mut [DVec3],
    pub hessian: HessianBlock<'a>,
}

impl ControlPass<'_> {
    /// Adds the folded terms of a block, and passes the fit on to the differences of Laplacians.
    pub fn block(
        &self,
        constitutive: &Constitutive<'_>,
        rows: &mut SolidRows<'_>,
        block: &mut SolidBlock,
        own: ControlRows<'_>,
        sum: &mut SolidSum,
    ) {
        let Self { bonds, sites, frame, plane } = self;
        let ControlRows { stresses, self_force, mut hessian } = own;
        let (n, first) = (rows.deformation.len(), block.first);
        let mut stretch = [DVec3::ZERO; BLOCK];
        let gather = Gather {
            bonds,
            sites,
            first,
            count: n,
            gradient: &mut block.gradient,
            residual: &mut block.residual,
            stretch: &mut stretch,
            volume: &mut block.volume,
            written: Written { stresses, self_force, ..Written::default() },
        };
        run_hot_in(*plane, gather);
        hessian.take_gradient(&block.gradient);
        // Without a fit there is nothing to resist.
        let has_fit = |k: usize| bonds.inverse_moment[first + k] != Sym3::ZERO;
        for k in (0..n).filter(|&k| !has_fit(k)) {
            block.residual[k] = 0.0;
        }
        stresses.fill(CorrectedStress::default());
        constitutive.fold(&mut constitutive.folded(rows, block, stresses), sum);
        for k in (0..n).filter(|&k| !has_fit(k)) {
            stresses[k] = CorrectedStress::default();
        }
        run_hot(CompleteStress { frame, bonds, sites, first, stretch: &stretch[..n], stresses, self_force });
    }
}

/// Places, m, and volumes, m3, of the particles in a reference.
#[derive(Clone, Copy)]
pub(super) struct ReferenceRows<'a> {
    pub places: &'a [DVec3],
    pub volumes: &'a [f64],
}

impl ReferenceRows<'_> {
    /// Whether some rows are as at the start, with F_r the identity; those that have been removed do not
    /// count.
    pub fn is_original(self, original: Self, gradient: &[DMat3], mut rows: Range<usize>) -> bool {
        rows.all(|row| {
            self.places[row] == original.places[row]
                && gradient[row] == DMat3::IDENTITY
                && (self.volumes[row] == original.volumes[row] || self.volumes[row] == 0.0)
        })
    }
}
