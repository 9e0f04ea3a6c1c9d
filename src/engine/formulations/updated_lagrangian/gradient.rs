//! First pass over pairs: the deformation gradient since the last update, then, while a block is in cache,
//! stress and corrected stress.

use glam::{DMat3, DVec3};

use super::control::{ControlPass, ControlRows};
use super::reference_fit::{FittedBlock, ReferenceFit};
use crate::formulations::bonded::{
    AffineFrame, Bonds, CompleteStress, CorrectStress, HessianBlock, PackedParticle, Written,
};
use crate::linalg::Sym3;
use crate::parallel::{BLOCK, run_hot, split_by_rows};
use crate::solids::{Constitutive, CorrectedStress, SolidBlock, SolidRows, SolidSum};

/// Packed rows that the pass writes, split by rows of one body.
pub(super) struct GradientRows<'a> {
    pub stresses: &'a mut [CorrectedStress],
    pub self_force: &'a mut [DVec3],
    /// B and k of the stabilizers, and their contributions from the particle itself; empty where they fold
    /// into the stress.
    pub control: &'a mut [CorrectedStress],
    pub control_force: &'a mut [DVec3],
    pub hessian: HessianBlock<'a>,
}

split_by_rows!(GradientRows { stresses, self_force, control, control_force, hessian });

/// The pass over one body.
pub(super) struct UpdatedGradientPass<'a> {
    pub bonds: &'a Bonds,
    pub sites: &'a [PackedParticle],
    /// The sums over these bonds, where they are known.
    pub fit: Option<&'a ReferenceFit>,
    /// F_r, where the reference is not the original one.
    pub gradient: Option<&'a [DMat3]>,
    /// Sums of the stabilizers, where they do not fold into the stress.
    pub control: Option<ControlPass<'a>>,
    /// V_0, m3.
    pub reference_volume: &'a [f64],
    pub frame: &'a AffineFrame,
    /// Plane strain.
    pub plane: bool,
}

impl UpdatedGradientPass<'_> {
    /// Runs the pass over a block of rows.
    pub fn block(
        &self,
        constitutive: &Constitutive<'_>,
        mut rows: SolidRows<'_>,
        own: GradientRows<'_>,
        block: &mut SolidBlock,
    ) -> SolidSum {
        let (n, first) = (rows.deformation.len(), block.first);
        let mut stretch = [DVec3::ZERO; BLOCK];
        let mut volume = [0.0; BLOCK];
        let GradientRows { stresses, self_force, control, control_force, mut hessian } = own;
        let fitted = FittedBlock {
            gradient: &mut block.gradient,
            residual: &mut block.residual,
            stretch: &mut stretch,
            volume: &mut volume,
            written: Written { deformation: rows.deformation, stress: rows.stress, stresses, self_force },
        };
        match self.fit {
            Some(fit) => fit.give(self.sites, first, n, fitted),
            None => fitted.sum(self.bonds, self.sites, self.plane, first, n),
        }
        hessian.after_fit(self.bonds, self.sites, first, &mut block.gradient[..n]);
        let f_r = self.follow(&volume, &mut rows, block);
        let inverse_moment = &self.bonds.inverse_moment[first..first + n];
        let shares = self.bonds.carried.get(first..first + n);
        let carried = |k: usize| match shares {
            _ if inverse_moment[k] == Sym3::ZERO => 0.0,
            Some(shares) => shares[k],
            None => 1.0,
        };
        let (mut sum, reference_volume) = (SolidSum::default(), block.volume);
        constitutive.stress(&mut rows, block, carried, &mut sum, |stress| {
            let mut seen = [DMat3::ZERO; BLOCK];
            let stress = f_r.map_or(stress, |f_r| {
                for (k, stress) in stress.iter().enumerate().filter(|(k, _)| volume[*k] > 0.0) {
                    // The stress as seen from the reference.
                    seen[k] = *stress * f_r[k].transpose() * (reference_volume[k] / volume[k]);
                }
                &seen[..n]
            });
            hessian.take_stress(stress);
            run_hot(CorrectStress { stress, inverse_moment, stresses: &mut *stresses });
        });
        block.brace(&rows);
        hessian.take_stiffness(&constitutive.folded(&mut rows, block, stresses));
        if self.control.is_none() {
            constitutive.fold(&mut constitutive.folded(&mut rows, block, stresses), &mut sum);
        }
        let (frame, bonds, sites) = (self.frame, self.bonds, self.sites);
        run_hot(CompleteStress { frame, bonds, sites, first, stretch: &stretch[..n], stresses, self_force });
        sum.close(&rows, block);
        if let Some(pass) = &self.control {
            let own = ControlRows { stresses: control, self_force: control_force, hessian };
            pass.block(constitutive, &mut rows, block, own, &mut sum);
        }
        sum
    }

    /// Multiplies the gradient since the last update with that up to it, F_r; returns F_r of the block.
    fn follow(
        &self,
        volume: &[f64; BLOCK],
        rows: &mut SolidRows<'_>,
        block: &mut SolidBlock,
    ) -> Option<&[DMat3]> {
        let f_r = self.gradient.map(|f_r| &f_r[block.first..block.first + rows.deformation.len()]);
        for (k, deformation) in rows.deformation.iter_mut().enumerate() {
            if let Some(f_r) = f_r {
                // F = f F_r; H = F - I keeps the digits of small strains.
                block.gradient[k] = block.gradient[k] * f_r[k] + (f_r[k] - DMat3::IDENTITY);
            }
            *deformation = DMat3::IDENTITY + block.gradient[k];
            block.volume[k] = if volume[k] > 0.0 { self.reference_volume[block.first + k] } else { 0.0 };
        }
        f_r
    }
}
