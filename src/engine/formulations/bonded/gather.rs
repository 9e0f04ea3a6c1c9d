//! The sums of the first pass over the bonds of every particle, and the fits from them.

use glam::{DMat3, DVec3};

use super::bonds::Bonds;
use super::displacement_moment::DisplacementMoment;
use super::rows::PackedParticle;
use crate::linalg::Sym3;
use crate::parallel::{
    BLOCK, FourLanes, HotLoop, Lanes4, PlaneOrSpace, for_each_own_block, run_hot_in, share_rows,
};
use crate::solids::{CorrectedStress, fit};

/// Fits the displacement gradient of a block of particles to the displacements of their neighbours.
pub(in crate::formulations) struct Gather<'a> {
    pub bonds: &'a Bonds,
    pub sites: &'a [PackedParticle],
    /// First row of the block in the phase.
    pub first: usize,
    /// Number of rows of the block.
    pub count: usize,
    pub gradient: &'a mut [DMat3; BLOCK],
    pub residual: &'a mut [f64; BLOCK],
    /// `sum_j V_j w_ij u_ij`.
    pub stretch: &'a mut [DVec3; BLOCK],
    pub volume: &'a mut [f64; BLOCK],
    /// Rows to be written after the gradients.
    pub written: Written<'a>,
}

/// Rows of the block that are written behind the sums; empty where that is not known. The sums leave time to
/// fetch them: written at once, they would be waited for.
#[derive(Clone, Copy, Default)]
pub(in crate::formulations) struct Written<'a> {
    pub deformation: &'a [DMat3],
    pub stress: &'a [DMat3],
    pub stresses: &'a [CorrectedStress],
    pub self_force: &'a [DVec3],
}

impl Written<'_> {
    #[inline(always)]
    fn prefetch<A: FourLanes>(&self, a: A, k: usize) {
        if k < self.stresses.len() {
            a.prefetch(self.deformation, k);
            a.prefetch(self.stress, k);
            a.prefetch(self.stresses, k);
            a.prefetch(self.self_force, k);
        }
    }
}

impl PlaneOrSpace for Gather<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Self { bonds, sites, first, count, gradient, residual, stretch, volume, written } = self;
        for k in 0..count {
            written.prefetch(a, k);
            let i = first + k;
            let site = sites[i];
            let DisplacementMoment { spread, stretched, square } =
                DisplacementMoment::<D>::over(a, bonds, sites, i);
            // A free particle has a zero inverse, and so F = I.
            let h = fit::<A, D>(a, &spread, &bonds.inverse_moment[i]);
            // sum V w |F X - x|^2 = sum V w u^2 - H : (sum V w u (x) X), because H = F - I is the
            // least-squares fit.
            let fitted: f64 = (0..D).map(|axis| h[axis].dot3(spread[axis])).sum();
            residual[k] = square.0[0] + square.0[1] + square.0[2] - fitted;
            stretch[k] = stretched.xyz();
            volume[k] = site.reference.0[3];
            gradient[k] = DMat3::from_cols(h[0].xyz(), h[1].xyz(), h[2].xyz());
        }
    }
}

/// Fits the displacement gradients of the rows of a body, which begin at `first`.
pub(in crate::formulations) fn fit_gradients(
    bonds: &Bonds,
    sites: &[PackedParticle],
    plane: bool,
    first: usize,
    gradient: &mut [DMat3],
) {
    for_each_own_block(&mut *gradient, &mut Vec::new(), &|start, gradient: &mut [DMat3]| {
        let (mut fitted, mut residual) = ([DMat3::ZERO; BLOCK], [0.0; BLOCK]);
        let (mut stretch, mut volume) = ([DVec3::ZERO; BLOCK], [0.0; BLOCK]);
        let gather = Gather {
            bonds,
            sites,
            first: first + start,
            count: gradient.len(),
            gradient: &mut fitted,
            residual: &mut residual,
            stretch: &mut stretch,
            volume: &mut volume,
            written: Written::default(),
        };
        run_hot_in(plane, gather);
        gradient.copy_from_slice(&fitted[..gradient.len()]);
    });
    share_rows(gradient);
}

/// Makes A_i = P_i M_i^-1 of a block.
pub(in crate::formulations) struct CorrectStress<'a> {
    pub stress: &'a [DMat3],
    pub inverse_moment: &'a [Sym3],
    pub stresses: &'a mut [CorrectedStress],
}

impl HotLoop for CorrectStress<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        for ((p, inverse), out) in self.stress.iter().zip(self.inverse_moment).zip(self.stresses) {
            let (x, y, z) = (p.x_axis, p.y_axis, p.z_axis);
            let columns = [Lanes4::new(x, 0.0), Lanes4::new(y, 0.0), Lanes4::new(z, 0.0)];
            out.columns = fit::<A, 3>(a, &columns, inverse);
        }
    }
}

/// Makes F = I + H of a block.
pub(in crate::formulations) struct AddIdentity<'a> {
    pub gradient: &'a [DMat3],
    pub deformation: &'a mut [DMat3],
}

impl HotLoop for AddIdentity<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let Self { gradient, deformation } = self;
        let n = gradient.len();
        let deformation = &mut deformation[..n];
        for k in 0..n {
            deformation[k] = DMat3::IDENTITY + gradient[k];
        }
    }
}
