//! The form of the paper: the gradient has the difference of second derivatives along a fixed vector added
//! (Vidal, Bonet, Huerta 2007, eq. 17).
//!
//! ```text
//! f_i = Q_i + eta D_i ,     D_i = sum_j V_j u_ij (x) (K_ij - E_i r_ij) - sum_j s_ij (Q_j - Q_i) ,     s_ij = V_j w_ij m_i . r_ij ,  m_i = M_i^-1 h
//! K_ij = b_ij (r_ij . h) r_ij - w_ij h ,  b_ij = (W'' + w_ij) / r_ij^2 ,     E_i = (sum_j V_j K_ij (x) r_ij) (sum_j V_j r_ij (x) r_ij)^-1
//! ```
//!
//! h has the smoothing length in every component. The strain energy is that of f, and the force its exact
//! adjoint: with T_i = V_0 P F_r^T = V_i Theta_i
//!
//! ```text
//! stress  eta [(m_i . sum_j V_j w_ij r_ij) Theta_i + sum_j V_j w_ij (m_j . r_ij) Theta_j]      beside that of the material
//! f_i += eta V_i sum_j V_j [Theta_i (K_ij - E_i r_ij) - Theta_j (K_ij + E_j r_ij)]
//! ```
//!
//! K and w are the same from both ends of a bond, so that none has to be looked up: a bond holds b, a
//! particle m and E. A ghost has the vector h in the mirror.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::super::bonds::Bonds;
use super::super::rows::PackedParticle;
use crate::correction::MomentMatrix;
use crate::kernels::Kernel;
use crate::linalg::{Sym3, dyad};
use crate::parallel::{FourLanes, HotLoop};
use crate::symmetry::Ghosts;

/// Rows of a reference configuration for the form.
#[derive(Default)]
pub(in crate::formulations) struct VidalRows {
    /// b_ij of every bond.
    pub(super) curvature: Vec<f32>,
    /// h of every row, m.
    pub(super) step: Vec<DVec3>,
    /// m_i.
    pub(super) shift: Vec<DVec3>,
    /// E_i.
    pub(super) correction: Vec<DMat3>,
}

/// The reference configuration of a body.
pub(super) struct VidalBody<'a> {
    pub bonds: &'a Bonds,
    pub ghosts: &'a Ghosts,
    pub sites: &'a [PackedParticle],
    pub kernel: Kernel,
    /// Support radii of the phase, m.
    pub support: &'a [f64],
}

impl VidalRows {
    /// Allocates memory for real rows and ghosts, and for the bonds.
    pub fn resize(&mut self, rows: usize, ghosts: usize, bonds: usize) {
        self.curvature.resize(bonds, 0.0);
        self.step.resize(rows + ghosts, DVec3::ZERO);
        self.shift.resize(rows + ghosts, DVec3::ZERO);
        self.correction.resize(rows + ghosts, DMat3::ZERO);
    }

    /// Makes everything of a body whose reference is new.
    pub(super) fn renew(&mut self, body: &VidalBody<'_>, rows: Range<usize>) {
        let VidalBody { bonds, ghosts, sites, kernel, support } = *body;
        let plane = kernel.dimension() == 2;
        for i in rows {
            let h = 0.5 * support[i];
            let step = DVec3::new(h, h, if plane { 0.0 } else { h });
            let (mut with_hessian, mut moment) = (DMat3::ZERO, Sym3::ZERO);
            for bond in bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize {
                let j = bonds.neighbors[bond] as usize;
                let arm = sites[j].reference.xyz() - sites[i].reference.xyz();
                let volume = sites[j].reference.0[3];
                let length = arm.length();
                let smoothing = kernel.smoothing_length(0.5 * (support[i] + support[ghosts.source(j)]));
                let weight = f64::from(bonds.weights[bond]);
                let curvature = (kernel.d2w_dr2(length, smoothing) + weight) / (length * length);
                self.curvature[bond] = if length > 0.0 { curvature as f32 } else { 0.0 };
                let k = along(f64::from(self.curvature[bond]), weight, arm, step);
                with_hessian += dyad(k, arm) * volume;
                moment += Sym3::dyad(arm) * volume;
            }
            let inverse = MomentMatrix::of(moment, kernel.dimension()).inverse().unwrap_or_default();
            self.step[i] = step;
            self.shift[i] = bonds.inverse_moment[i] * step;
            self.correction[i] = with_hessian * inverse.to_matrix();
        }
    }

    /// Copies the rows of the reference to the ghosts.
    pub fn renew_ghosts(&mut self, ghosts: &Ghosts) {
        ghosts.fill(&mut self.step, |ghost, step| ghost.map.vector(*step));
        ghosts.fill(&mut self.shift, |ghost, shift| ghost.map.vector(*shift));
        ghosts.fill(&mut self.correction, |ghost, correction| ghost.map.tensor(*correction));
    }
}

/// K_ij.
#[inline(always)]
pub(super) fn along(curvature: f64, weight: f64, arm: DVec3, step: DVec3) -> DVec3 {
    arm * (curvature * arm.dot(step)) - step * weight
}

/// D_i times eta for the rows of a block, added to their displacement gradients.
pub(super) struct VidalDifference<'a> {
    pub rows: &'a VidalRows,
    pub bonds: &'a Bonds,
    pub sites: &'a [PackedParticle],
    /// Displacement gradients of all rows.
    pub gradient: &'a [DMat3],
    pub eta: f64,
    /// First row of the block.
    pub first: usize,
    pub block: &'a mut [DMat3],
}

impl HotLoop for VidalDifference<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let Self { rows, bonds, sites, gradient, eta, first, block } = self;
        for (k, out) in block.iter_mut().enumerate() {
            let i = first + k;
            if bonds.inverse_moment[i] == Sym3::ZERO {
                continue;
            }
            let (site, step, shift, correction) =
                (&sites[i], rows.step[i], rows.shift[i], rows.correction[i]);
            let mut sum = DMat3::ZERO;
            for bond in bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize {
                let j = bonds.neighbors[bond] as usize;
                let other = &sites[j];
                let weight = f64::from(bonds.weights[bond]);
                let arm = other.reference.xyz() - site.reference.xyz();
                let change = other.displacement.xyz() - site.displacement.xyz();
                let second = along(f64::from(rows.curvature[bond]), weight, arm, step) - correction * arm;
                let of_gradient = (gradient[j] - gradient[i]) * (weight * shift.dot(arm));
                sum += (dyad(change, second) - of_gradient) * other.reference.0[3];
            }
            *out += sum * eta;
        }
    }
}
