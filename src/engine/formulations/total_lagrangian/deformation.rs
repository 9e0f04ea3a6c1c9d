//! First pass over pairs: the deformation gradient, then, while a block is in cache, stress and corrected
//! stress.
//!
//! `F_i = I + (sum_j V_j w_ij u_ij (x) X_ij) M_i^-1` is the weighted least-squares fit of the current pair
//! vectors (Ganzenmueller 2015, eq. 13, with the correction of eq. 10 written as one inverse; displacements
//! keep the digits of small strains). In plane strain the third row and column are those of the identity.

use glam::DVec3;

use crate::formulations::bonded::{
    AddIdentity, AffineFrame, Bonds, CompleteStress, CorrectStress, EdgeRows, FailureState, Gather,
    HessianBlock, PackedParticle, Written,
};
use crate::linalg::Sym3;
use crate::parallel::{BLOCK, Split, run_hot, run_hot_in};
use crate::solids::{Constitutive, CorrectedStress, SolidBlock, SolidRows, SolidSum};
use crate::symmetry::Ghosts;
use crate::world::Velocity;

/// Packed rows that the pass writes, split by rows of one body.
pub(super) struct DeformationRows<'a> {
    pub stresses: &'a mut [CorrectedStress],
    /// `A_i sum_j V_j w_ij X_ij + k_i sum_j V_j w_ij u_ij`, the part of the force that knows no stress but
    /// its own.
    pub self_force: &'a mut [DVec3],
    pub edges: EdgeRows<'a>,
    pub hessian: HessianBlock<'a>,
}

impl Split for DeformationRows<'_> {
    fn rows(&self) -> usize {
        self.stresses.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (stresses, stresses_rest) = self.stresses.split_at_mut(at);
        let (self_force, self_force_rest) = self.self_force.split_at_mut(at);
        let (edges, edges_rest) = self.edges.split(at);
        let (hessian, hessian_rest) = self.hessian.split(at);
        (
            Self { stresses, self_force, edges, hessian },
            Self {
                stresses: stresses_rest,
                self_force: self_force_rest,
                edges: edges_rest,
                hessian: hessian_rest,
            },
        )
    }
}

/// The pass over one body.
pub(super) struct DeformationPass<'a> {
    pub bonds: &'a Bonds,
    pub ghosts: &'a Ghosts,
    pub sites: &'a [PackedParticle],
    pub frame: &'a AffineFrame,
    /// Which rows have failed; looked at where there are edges.
    pub states: &'a [FailureState],
    pub velocity: &'a [Velocity],
    /// Plane strain.
    pub plane: bool,
}

impl DeformationPass<'_> {
    /// Runs the pass over a block of rows.
    pub fn run(
        &self,
        constitutive: &Constitutive<'_>,
        mut rows: SolidRows<'_>,
        own: DeformationRows<'_>,
        block: &mut SolidBlock,
    ) -> SolidSum {
        let (n, first) = (rows.deformation.len(), block.first);
        let mut stretch = [DVec3::ZERO; BLOCK];
        let (bonds, sites) = (self.bonds, self.sites);
        let DeformationRows { stresses, self_force, edges, mut hessian } = own;
        let gather = Gather {
            bonds,
            sites,
            first,
            count: n,
            gradient: &mut block.gradient,
            residual: &mut block.residual,
            stretch: &mut stretch,
            volume: &mut block.volume,
            written: Written { deformation: rows.deformation, stress: rows.stress, stresses, self_force },
        };
        run_hot_in(self.plane, gather);
        hessian.after_fit(bonds, sites, first, &mut block.gradient[..n]);
        run_hot(AddIdentity { gradient: &block.gradient[..n], deformation: rows.deformation });
        let inverse_moment = &bonds.inverse_moment[first..first + n];
        let shares = bonds.carried.get(first..first + n);
        let carried = |k: usize| match shares {
            _ if inverse_moment[k] == Sym3::ZERO => 0.0,
            Some(shares) => shares[k],
            None => 1.0,
        };
        let mut sum = SolidSum::default();
        constitutive.stress(&mut rows, block, carried, &mut sum, |stress| {
            hessian.take_stress(stress);
            run_hot(CorrectStress { stress, inverse_moment, stresses: &mut *stresses });
        });
        block.brace(&rows);
        hessian.take_stiffness(&constitutive.folded(&mut rows, block, stresses));
        self.add_terms(constitutive, constitutive.folded(&mut rows, block, stresses), edges, &mut sum);
        let frame = self.frame;
        run_hot(CompleteStress { frame, bonds, sites, first, stretch: &stretch[..n], stresses, self_force });
        sum.close(&rows, block);
        sum
    }
}
