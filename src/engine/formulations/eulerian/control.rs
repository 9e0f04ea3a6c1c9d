//! Hourglass control along pairs: the exact gradient of an energy of positions and deformation gradients.
//!
//! ```text
//! U = sum_i xi/4 E_i V_0,i sum_j V_0,j m_ij w_ij [s_ij^2 + q min(E_i, E_j)/E (|e_ij|^2 - s_ij^2)] ,   e_ij = F_i X_ij - x_ij ,   s_ij = e_ij . x_ij / |x_ij| ,   m_ij = min(1, H^2 / |X_ij|^2)^2
//! ```
//!
//! The residual along the pair, s_ij, is the one that grows in tension. The transverse residual has the
//! weight q: in a twisted body, u = a (-z y, z x, 0), it is the whole residual, because u . x = 0. Its weight
//! decreases with the smaller modulus of the pair over Young's modulus E: neighbours slide past each other
//! where either of them flows.
//!
//! F is a state and not a function of the positions. U therefore changes in two ways: by the motion of the
//! pairs at fixed F, which gives a force on the pair, and by dF/dt = L F, which gives the Kirchhoff stress
//! `(dU/dF_i) F_i^T / V_0,i`. The adjoint of L turns the latter into forces, as it does for the stress of the
//! material. The sum of all energies is conserved; so is angular momentum, because U does not change where
//! positions and F rotate together.
//!
//! Each particle resists the residual of its own F, as in the variational form of Lagrangian bodies. With the
//! mean F of both particles the residual is of third order in bending, and the body stays as soft as the
//! averaged gradient makes it. The weight is that of the velocity gradient: with a steeper one, W / |X|^2,
//! bending would need three times the largest stiffness. m_ij reduces the weight of pairs that were
//! originally further apart than the support H and became neighbours by flow.

use glam::{DMat3, DVec3};

use super::control_pairs::ControlPairs;
use super::control_rows::{BodyControl, EulerianControlRows};
use super::divergence::{Divergence, corrected};
use super::rows::EulerianRows;
use crate::column;
use crate::parallel::{
    FourLanes, HotLoop, Lanes4, for_each_own_block, run_hot_on, share_rows, split_by_rows,
};
use crate::solids::{CorrectedStress, CorrectedStressRows, FoldedEnergy};

column! {
    /// Energy of the hourglass control along pairs: half of that of all pairs of the particle.
    pub struct HourglassEnergy(f64) = "hourglass_energy", "U_h", "J";
}

/// Runs the pass over body `k`: adds the stress of the control, writes its forces, and returns its energy.
/// `energy` are the rows of [`HourglassEnergy`] of the body after the last step, J.
pub(super) fn run(
    packed: &mut EulerianRows,
    k: usize,
    control: BodyControl,
    energy: &mut [HourglassEnergy],
    mass: &[crate::world::Mass],
) -> FoldedEnergy {
    let EulerianRows {
        lists, kernels, points, supports, carried, near, stresses, control: own, plane, ..
    } = packed;
    let rows = lists.bodies[k].rows.clone();
    let EulerianControlRows { force, stiffness, sums } = own;
    let block = ControlBlock {
        force: &mut force[rows.clone()],
        stiffness: &mut stiffness[rows.clone()],
        stresses: &mut stresses[rows.clone()],
        energy: &mut *energy,
    };
    let (divergence, support, offsets) =
        (kernels[k].divergence, lists.bodies[k].support, lists.pairs.offsets());
    let ellipsoids = supports.of(&lists.bodies[k]);
    let sum = for_each_own_block(block, sums, &|first, block: ControlBlock<'_>| {
        let first = rows.start + first;
        let pairs =
            ControlPairs { support, offsets, near, points, ellipsoids, carried, across: control.across };
        let pass = EulerianControlPass { control, divergence, pairs, mass, first };
        let mut sum = FoldedEnergy::default();
        run_hot_on(*plane, ControlLoop { pass, block, sum: &mut sum });
        sum
    });
    share_rows(&mut force[rows.clone()]);
    share_rows(&mut stiffness[rows.clone()]);
    share_rows(&mut stresses[rows]);
    share_rows(energy);
    sum
}

struct EulerianControlPass<'a> {
    control: BodyControl,
    divergence: Divergence,
    pairs: ControlPairs<'a>,
    mass: &'a [crate::world::Mass],
    first: usize,
}

struct ControlBlock<'a> {
    force: &'a mut [Lanes4],
    stiffness: &'a mut [f64],
    stresses: &'a mut [CorrectedStress],
    energy: &'a mut [HourglassEnergy],
}

split_by_rows!(ControlBlock { force, stiffness, stresses, energy });

struct ControlLoop<'a, 's> {
    pass: EulerianControlPass<'a>,
    block: ControlBlock<'a>,
    sum: &'s mut FoldedEnergy,
}

impl HotLoop for ControlLoop<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Self { pass, block, sum } = self;
        let ControlBlock { force, stiffness, stresses, energy } = block;
        let BodyControl { xi, density, .. } = pass.control;
        for k in 0..force.len() {
            let own = &pass.pairs.carried[pass.first + k];
            let sums = pass.pairs.of_row(a, pass.first + k);
            let scale = xi * own.volume();
            force[k] = Lanes4::new(sums.force * scale, 0.0);
            stiffness[k] = xi / density * sums.stiffness;
            let (now, with_modulus_before) = (0.25 * scale * sums.energy, 0.25 * scale * sums.energy_before);
            let last = std::mem::replace(&mut energy[k].0, now);
            sum.stored += now;
            if with_modulus_before > 0.0 {
                // The trapezoidal rule of the leapfrog spends (E_n - E_n+1)/2 s_n s_n+1 beyond the change of
                // energy.
                sum.released += (with_modulus_before - now) * (last / with_modulus_before).sqrt();
            } else {
                sum.released -= now;
            }
            let slope = sums.couple * scale;
            let mut stress = slope * own.deformation().transpose();
            if sums.turn != DVec3::ZERO {
                let DVec3 { x, y, z } = sums.turn * -scale;
                stress +=
                    DMat3::from_cols(DVec3::new(0.0, z, -y), DVec3::new(-z, 0.0, x), DVec3::new(y, -x, 0.0));
            }
            pass.add_stress(k, &stress, &mut stresses[k]);
        }
    }
}

impl EulerianControlPass<'_> {
    /// Adds V_0,i times a Kirchhoff stress to what neighbours read of row `k`.
    #[inline(always)]
    fn add_stress(&self, k: usize, stress: &DMat3, row: &mut CorrectedStress) {
        let i = self.first + k;
        let point = &self.pairs.points[i];
        if point.place.0[3] > 0.0 {
            let stress = *stress * (1.0 / point.place.0[3]);
            let around = &self.pairs.near.around[i];
            let add = corrected(self.divergence, &stress, around, self.mass[i].0, point);
            CorrectedStressRows(std::slice::from_mut(row)).add_scaled(0, 1.0, &add);
        }
    }
}
