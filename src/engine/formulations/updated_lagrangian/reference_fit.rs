//! The fit of the deformation since the last update, at the positions of a new reference: it gives F_r, and
//! the following pass at the same positions reuses it.

use std::ops::Range;

use glam::{DMat3, DVec3};

use crate::formulations::bonded::{Bonds, Gather, PackedParticle, Written};
use crate::parallel::{BLOCK, for_each_own_block, run_hot_in, share_rows_of};

/// Sums of the first pass for all real rows of the phase.
#[derive(Default)]
pub(super) struct ReferenceFit {
    /// f - I, of all ranks.
    pub gradient: Vec<DMat3>,
    /// Error of the fit, `sum_j V_j w_ij |f_i r_ij - x_ij|^2`, of the rows of this rank.
    residual: Vec<f64>,
    /// `sum_j V_j w_ij u_ij`, of the rows of this rank.
    stretch: Vec<DVec3>,
}

/// The rows of a block that the first pass fills.
pub(super) struct FittedBlock<'a> {
    pub gradient: &'a mut [DMat3; BLOCK],
    pub residual: &'a mut [f64; BLOCK],
    pub stretch: &'a mut [DVec3; BLOCK],
    pub volume: &'a mut [f64; BLOCK],
    pub written: Written<'a>,
}

impl FittedBlock<'_> {
    /// Sums over the bonds of the rows from `first` on, that many.
    pub fn sum(self, bonds: &Bonds, sites: &[PackedParticle], plane: bool, first: usize, count: usize) {
        let Self { gradient, residual, stretch, volume, written } = self;
        run_hot_in(
            plane,
            Gather { bonds, sites, first, count, gradient, residual, stretch, volume, written },
        );
    }
}

impl ReferenceFit {
    /// Fits the rows of bodies at the places that the sites hold.
    pub fn make(
        &mut self,
        bonds: &Bonds,
        sites: &[PackedParticle],
        plane: bool,
        bodies: impl Iterator<Item = Range<usize>> + Clone,
    ) {
        let Self { gradient, residual, stretch } = self;
        let count = bonds.inverse_moment.len();
        gradient.resize(count, DMat3::ZERO);
        residual.resize(count, 0.0);
        stretch.resize(count, DVec3::ZERO);
        for rows in bodies.clone() {
            let start = rows.start;
            let own = (&mut gradient[rows.clone()], &mut residual[rows.clone()], &mut stretch[rows]);
            type Rows<'a> = (&'a mut [DMat3], &'a mut [f64], &'a mut [DVec3]);
            for_each_own_block(own, &mut Vec::new(), &|first, (gradient, residual, stretch): Rows<'_>| {
                let (mut fitted, mut error) = ([DMat3::ZERO; BLOCK], [0.0; BLOCK]);
                let (mut sum, mut volume, n) = ([DVec3::ZERO; BLOCK], [0.0; BLOCK], gradient.len());
                let block = FittedBlock {
                    gradient: &mut fitted,
                    residual: &mut error,
                    stretch: &mut sum,
                    volume: &mut volume,
                    written: Written::default(),
                };
                block.sum(bonds, sites, plane, start + first, n);
                gradient.copy_from_slice(&fitted[..n]);
                residual.copy_from_slice(&error[..n]);
                stretch.copy_from_slice(&sum[..n]);
            });
        }
        share_rows_of(gradient, bodies);
    }

    /// Gives the rows from `first` on, that many, what sums over their bonds would give.
    pub fn give(&self, sites: &[PackedParticle], first: usize, count: usize, block: FittedBlock<'_>) {
        let rows = first..first + count;
        block.gradient[..count].copy_from_slice(&self.gradient[rows.clone()]);
        block.residual[..count].copy_from_slice(&self.residual[rows.clone()]);
        block.stretch[..count].copy_from_slice(&self.stretch[rows.clone()]);
        for (volume, site) in block.volume.iter_mut().zip(&sites[rows]) {
            *volume = site.reference.0[3];
        }
    }
}
