//! First pass over pairs: the deformation gradient since the last update, then, while a block is in cache, stress and corrected stress.

use glam::{DMat3, DVec3};

use super::control::ControlFit;
use crate::formulations::total_lagrangian::{Bonds, CorrectStress, Frame, Gather, HessianBlock, Site};
use crate::linalg::Sym3;
use crate::parallel::{BLOCK, run_hot, run_hot_in, split_by_rows};
use crate::solids::{Constitutive, CorrectedStress, SolidBlock, SolidRows, SolidSum};

/// What the pass writes of packed rows, cut by rows of one body.
pub(super) struct GradientRows<'a> {
    pub stresses: &'a mut [CorrectedStress],
    pub control: &'a mut [CorrectedStress],
    pub self_force: &'a mut [DVec3],
    pub hessian: HessianBlock<'a>,
}

split_by_rows!(GradientRows { stresses, control, self_force, hessian });

/// The pass over one body.
pub(super) struct GradientPass<'a> {
    pub bonds: &'a Bonds,
    /// The bonds as the stabilizers see them.
    pub control_bonds: &'a Bonds,
    pub sites: &'a [Site],
    pub originals: &'a [Site],
    /// F_r.
    pub gradient: &'a [DMat3],
    /// V_0, m3.
    pub reference_volume: &'a [f64],
    pub frame: &'a Frame,
    /// Plane strain.
    pub plane: bool,
}

/// What the folded terms of a block write.
struct ControlRows<'a> {
    control: &'a mut [CorrectedStress],
    hessian: HessianBlock<'a>,
}

impl GradientPass<'_> {
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
        let gather = Gather {
            bonds: self.bonds,
            sites: self.sites,
            first,
            deformation: rows.deformation,
            gradient: &mut block.gradient,
            residual: &mut block.residual,
            stretch: &mut stretch,
            volume: &mut volume,
        };
        run_hot_in(self.plane, gather);
        let GradientRows { stresses, control, self_force, mut hessian } = own;
        hessian.after_fit(self.bonds, self.sites, first, &mut block.gradient[..n]);
        let f_r = &self.gradient[first..first + n];
        for (k, f_r) in f_r.iter().enumerate() {
            // F = f F_r; H = F - I keeps the digits of small strains where the reference is still the original one.
            block.gradient[k] = block.gradient[k] * *f_r + (*f_r - DMat3::IDENTITY);
            rows.deformation[k] = DMat3::IDENTITY + block.gradient[k];
            block.volume[k] = if volume[k] > 0.0 { self.reference_volume[first + k] } else { 0.0 };
        }
        let inverse_moment = &self.bonds.inverse_moment[first..first + n];
        let shares = self.bonds.carried.get(first..first + n);
        let carried = |k: usize| match shares {
            _ if inverse_moment[k] == Sym3::ZERO => 0.0,
            Some(shares) => shares[k],
            None => 1.0,
        };
        let mut sum = SolidSum::default();
        let reference_volume = block.volume;
        constitutive.stress(&mut rows, block, carried, &mut sum, |stress| {
            let mut seen = [DMat3::ZERO; BLOCK];
            for (k, stress) in stress.iter().enumerate().filter(|(k, _)| volume[*k] > 0.0) {
                // The stress as seen from the reference.
                seen[k] = *stress * f_r[k].transpose() * (reference_volume[k] / volume[k]);
            }
            hessian.take_stress(&seen);
            run_hot(CorrectStress { stress: &seen[..n], inverse_moment, stresses: &mut *stresses });
        });
        hessian.take_stiffness(&constitutive.folded(&mut rows, block, stresses));
        for (k, (stress, self_force)) in stresses.iter_mut().zip(self_force).enumerate() {
            self.frame.complete(stress, &self.sites[first + k]);
            *self_force = stress.times(self.bonds.reach[first + k], stretch[k]);
        }
        sum.close(&rows, block);
        if !constitutive.terms.is_empty() || hessian.needs_gradient() {
            self.add_control(constitutive, &mut rows, block, ControlRows { control, hessian }, &mut sum);
        }
        sum
    }

    /// Adds the folded terms, with the fit to the original pair vectors, and hands that on to the differences of Laplacians.
    fn add_control(
        &self,
        constitutive: &Constitutive<'_>,
        rows: &mut SolidRows<'_>,
        block: &mut SolidBlock,
        own: ControlRows<'_>,
        sum: &mut SolidSum,
    ) {
        let ControlRows { control, mut hessian } = own;
        let (n, first) = (rows.deformation.len(), block.first);
        let mut fitted = [false; BLOCK];
        let fit = ControlFit {
            bonds: self.control_bonds,
            sites: self.originals,
            rows: first..first + n,
            gradient: &mut block.gradient,
            residual: &mut block.residual,
            volume: &mut block.volume,
            fitted: &mut fitted,
        };
        run_hot_in(self.plane, fit);
        hessian.take_gradient(&block.gradient);
        control.fill(CorrectedStress::default());
        constitutive.fold(&mut constitutive.folded(rows, block, control), sum);
        for (stress, _) in control.iter_mut().zip(fitted).filter(|(_, fitted)| !fitted) {
            *stress = CorrectedStress::default();
        }
    }
}
