//! Hourglass control from the original pair vectors X_ij, with weights of the reference.
//!
//! ```text
//! H_i = (sum_j V_j w_ij u_ij (x) X_ij) (sum_j V_j w_ij X_ij (x) X_ij)^-1 ,   u_ij = x_ij - X_ij
//! force_i = V_i sum_j V_j w_ij [(B_i + B_j) X_ij + (k_i + k_j) u_ij]
//! ```
//!
//! Folded terms compute B and k from H and from the residual `sum_j V_j w_ij |H_i X_ij - u_ij|^2`. H_i is the fit that minimizes the residual.
//! Between updates the force of a variational term is therefore the exact gradient of its energy, without torque on a body in rigid motion. With increments measured from the last update,
//! every update would erase the residual that the control resists.
//!
//! The weight is evaluated at the distance `|(F_r,i + F_r,j) X_ij| / 2`, which follows from the deformation alone, and not at the distance of the particles. The latter contains the
//! hourglass motion: at the next update a pair that has come too close would get a larger weight, and with it energy without work (two colliding rubber rings, updates
//! every three steps: 18 J of 36 J).
//!
//! Failed particles are in no sum.

use std::ops::Range;

use glam::{DMat3, DVec3};

use crate::correction::MomentMatrix;
use crate::formulations::total_lagrangian::{Bonds, Site, fit};
use crate::linalg::Sym3;
use crate::parallel::{BLOCK, FourLanes, Lanes4, PlaneOrSolid};
use crate::solids::CorrectedStress;
use crate::world::Force;

/// Fits H to a block of particles.
pub(super) struct ControlFit<'a> {
    pub bonds: &'a Bonds,
    /// Original places with the volumes of what holds, and displacements since the start.
    pub sites: &'a [Site],
    pub rows: Range<usize>,
    pub gradient: &'a mut [DMat3; BLOCK],
    pub residual: &'a mut [f64; BLOCK],
    pub volume: &'a mut [f64; BLOCK],
    /// Whether there are enough neighbours for a fit.
    pub fitted: &'a mut [bool; BLOCK],
}

impl PlaneOrSolid for ControlFit<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Self { bonds, sites, rows, gradient, residual, volume, fitted } = self;
        for (k, i) in rows.enumerate() {
            let own = sites[i];
            let (mut moment, mut spread) = ([Lanes4::ZERO; D], [Lanes4::ZERO; D]);
            let mut square = Lanes4::ZERO;
            for bond in bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize {
                let other = &sites[bonds.neighbors[bond] as usize];
                let weight = f64::from(bonds.weights[bond]) * other.reference.0[3];
                let arm = a.minus(other.reference, own.reference);
                let change = a.minus(other.displacement, own.displacement);
                let (weighted_arm, weighted) = (a.scale(weight, arm), a.scale(weight, change));
                for axis in 0..D {
                    moment[axis] = a.scale_add(arm.0[axis], weighted_arm, moment[axis]);
                    spread[axis] = a.scale_add(arm.0[axis], weighted, spread[axis]);
                }
                square = a.times_add(change, weighted, square);
            }
            let inverse = MomentMatrix::of(symmetric(&moment), D).inverse().filter(|_| own.is_present());
            fitted[k] = inverse.is_some();
            let h = fit::<A, D>(a, &spread, &inverse.unwrap_or_default());
            let explained: f64 = (0..D).map(|axis| h[axis].dot3(spread[axis])).sum();
            let unexplained = square.0[0] + square.0[1] + square.0[2] - explained;
            residual[k] = if fitted[k] { unexplained } else { 0.0 };
            gradient[k] = DMat3::from_cols(h[0].xyz(), h[1].xyz(), h[2].xyz());
            volume[k] = own.reference.0[3];
        }
    }
}

/// The symmetric matrix with those columns.
#[inline(always)]
fn symmetric<const D: usize>(columns: &[Lanes4; D]) -> Sym3 {
    let [x, y] = [columns[0].0, columns[1].0];
    let plane = Sym3 { xx: x[0], yy: y[1], xy: x[1], ..Sym3::ZERO };
    match columns.get(2) {
        Some(z) => Sym3 { zz: z.0[2], xz: z.0[0], yz: z.0[1], ..plane },
        None => plane,
    }
}

/// Adds the force of the control to a block of rows.
pub(super) struct ControlForce<'a> {
    pub bonds: &'a Bonds,
    /// Pull of the differences of Laplacians; empty without them.
    pub pull: &'a [DVec3],
    pub sites: &'a [Site],
    pub control: &'a [CorrectedStress],
    pub first: usize,
    pub force: &'a mut [Force],
}

impl PlaneOrSolid for ControlForce<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Self { bonds, pull, sites, control, first, force } = self;
        for (k, force) in force.iter_mut().enumerate() {
            let i = first + k;
            let (site, own) = (sites[i], &control[i]);
            let mut sum = Lanes4::ZERO;
            for bond in bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize {
                let j = bonds.neighbors[bond] as usize;
                let (other, theirs) = (&sites[j], &control[j]);
                let weight = f64::from(bonds.weights[bond]) * other.reference.0[3];
                let arm = a.minus(other.reference, site.reference);
                let change = a.minus(other.displacement, site.displacement);
                let mut traction = a.scale(own.stiffness() + theirs.stiffness(), change);
                for axis in 0..D {
                    let column = a.plus(own.columns[axis], theirs.columns[axis]);
                    traction = a.scale_add(arm.0[axis], column, traction);
                }
                if !pull.is_empty() {
                    traction = a.plus(traction, Lanes4::new(pull[i] - pull[j], 0.0));
                }
                sum = a.scale_add(weight, traction, sum);
            }
            force.0 += sum.xyz() * site.reference.0[3];
        }
    }
}
