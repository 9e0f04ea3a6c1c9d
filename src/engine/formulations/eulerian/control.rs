//! Hourglass control along pairs: the exact gradient of an energy of places and deformation gradients.
//!
//! ```text
//! U = sum_i xi/4 E_i V_0,i sum_j V_0,j m_ij w_ij s_ij^2 ,   s_ij = (F_i X_ij) . x_ij / |x_ij| - |x_ij| ,   m_ij = min(1, H^2 / |X_ij|^2)^2
//! ```
//!
//! F is no function of the places: it goes along with the velocity gradient. So U changes by the motion of the pairs at fixed F, which gives a force on the
//! pair, and by dF/dt = L F, which gives the stress `(dU/dF_i) F_i^T / V_i`. The adjoint of L makes forces of it, as of the stress of the material. What is
//! conserved is the sum of all energies, and as U does not change where places and F turn together, the angular momentum.
//!
//! Each particle resists the error of its own F, as in the variational form of Lagrangian bodies: that of the mean of both is of third order in a body that
//! bends, and leaves it as soft as the mean gradient makes it. The weight is that of the velocity gradient: a steeper one, as W / |X|^2, needs thrice
//! the largest stiffness for the same in bending. Pairs that were further apart than the support H, and have met in a flow, count less and less.

use glam::{DMat3, DVec3};

use super::near::Near;
use super::parameters::Divergence;
use super::rows::{EulerianRows, Point};
use super::stress::corrected;
use crate::column;
use crate::parallel::{Arithmetic, Lanes4, PlaneOrSolid, Split, for_each_block, run_hot_in};
use crate::solids::{CorrectedStress, CorrectedStressRows, FoldedEnergy};
use crate::symmetry::Map;

column! {
    /// Energy of the hourglass control along pairs: half of that of all pairs of the particle.
    pub struct HourglassEnergy(f64) = "hourglass_energy", "U_h", "J";
}

/// What a particle carries along from the start, as its neighbours read it.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Carried {
    /// The columns of F, and in their last lanes the modulus of the control, that of the last step, Pa, and the reference volume, m3.
    columns: [Lanes4; 3],
    /// X.
    pub original: Lanes4,
}

impl Carried {
    /// Takes up F, the modulus, Pa, and the reference volume, m3.
    pub fn set(&mut self, f: &DMat3, modulus: f64, volume: f64) {
        let before = self.modulus_before();
        self.columns =
            [Lanes4::new(f.x_axis, modulus), Lanes4::new(f.y_axis, before), Lanes4::new(f.z_axis, volume)];
    }

    /// Takes up the modulus of the last step, Pa.
    pub fn set_modulus_before(&mut self, modulus: f64) {
        self.columns[1].0[3] = modulus;
    }

    fn deformation(&self) -> DMat3 {
        let [x, y, z] = self.columns;
        DMat3::from_cols(x.xyz(), y.xyz(), z.xyz())
    }

    #[inline(always)]
    fn modulus(&self) -> f64 {
        self.columns[0].0[3]
    }

    #[inline(always)]
    fn modulus_before(&self) -> f64 {
        self.columns[1].0[3]
    }

    /// The modulus, Pa, with which it resists the error of a neighbour: none across cracks.
    #[inline(always)]
    fn resists(&self, other: &Self) -> f64 {
        if other.modulus() > 0.0 { self.modulus() } else { 0.0 }
    }

    /// That of the last step, Pa.
    #[inline(always)]
    fn resisted(&self, other: &Self) -> f64 {
        if other.modulus_before() > 0.0 { self.modulus_before() } else { 0.0 }
    }

    #[inline(always)]
    fn volume(&self) -> f64 {
        self.columns[2].0[3]
    }

    /// That of a ghost.
    pub fn image(&self, map: &Map) -> Self {
        let mut image = Self { original: Lanes4::new(map.place(self.original.xyz()), 0.0), ..*self };
        for (axis, column) in image.columns.iter_mut().enumerate() {
            *column = Lanes4::new(column.xyz() * map.signs * map.signs[axis], column.0[3]);
        }
        image
    }
}

/// What the pass writes of every row.
#[derive(Default)]
pub(super) struct ControlRows {
    /// Force at fixed F, N.
    pub force: Vec<Lanes4>,
    /// Sum of the stiffnesses of the pairs over the mass of the particle, 1/s2.
    pub stiffness: Vec<f64>,
    sums: Vec<FoldedEnergy>,
}

/// The control of a body.
#[derive(Clone, Copy)]
pub(super) struct BodyControl {
    pub xi: f64,
    /// Density rho_0, kg/m3.
    pub density: f64,
}

impl ControlRows {
    /// Room for real rows.
    pub fn resize(&mut self, rows: usize) {
        self.force.resize(rows, Lanes4::ZERO);
        self.stiffness.resize(rows, 0.0);
    }
}

/// Runs the pass over body `k`: adds the stress of the control to what is there, writes its forces, and gives its energy. `energy` are the rows of
/// [`HourglassEnergy`] of the body, as the last step left them, J.
pub(super) fn run(
    packed: &mut EulerianRows,
    k: usize,
    control: BodyControl,
    energy: &mut [HourglassEnergy],
    mass: &[crate::world::Mass],
) -> FoldedEnergy {
    let EulerianRows { lists, kernels, points, carried, near, stresses, control: own, plane, .. } = packed;
    let rows = lists.bodies[k].rows.clone();
    let ControlRows { force, stiffness, sums } = own;
    let block = ControlBlock {
        force: &mut force[rows.clone()],
        stiffness: &mut stiffness[rows.clone()],
        stresses: &mut stresses[rows.clone()],
        energy,
    };
    let (divergence, support, offsets) = (kernels[k].divergence, lists.bodies[k].support, &lists.offsets[..]);
    for_each_block(block, sums, &|first, block: ControlBlock<'_>| {
        let first = rows.start + first;
        let pass = ControlPass { control, divergence, support, offsets, near, points, carried, mass, first };
        let mut sum = FoldedEnergy::default();
        run_hot_in(*plane, ControlLoop { pass, block, sum: &mut sum });
        sum
    })
}

struct ControlPass<'a> {
    control: BodyControl,
    divergence: Divergence,
    support: f64,
    offsets: &'a [usize],
    near: &'a Near,
    points: &'a [Point],
    carried: &'a [Carried],
    mass: &'a [crate::world::Mass],
    first: usize,
}

struct ControlBlock<'a> {
    force: &'a mut [Lanes4],
    stiffness: &'a mut [f64],
    stresses: &'a mut [CorrectedStress],
    energy: &'a mut [HourglassEnergy],
}

impl Split for ControlBlock<'_> {
    fn rows(&self) -> usize {
        self.force.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (force, force_rest) = self.force.split_at_mut(at);
        let (stiffness, stiffness_rest) = self.stiffness.split_at_mut(at);
        let (stresses, stresses_rest) = self.stresses.split_at_mut(at);
        let (energy, energy_rest) = self.energy.split_at_mut(at);
        (
            Self { force, stiffness, stresses, energy },
            Self {
                force: force_rest,
                stiffness: stiffness_rest,
                stresses: stresses_rest,
                energy: energy_rest,
            },
        )
    }
}

struct ControlLoop<'a, 's> {
    pass: ControlPass<'a>,
    block: ControlBlock<'a>,
    sum: &'s mut FoldedEnergy,
}

/// Sums over the pairs of a row, without xi and the volume of the row.
struct PairSums<const D: usize> {
    /// dU/dx.
    force: Lanes4,
    /// The columns of dU/dF.
    couple: [Lanes4; D],
    stiffness: f64,
    /// Twice the energies, with the moduli of now and of the last step.
    energy: f64,
    energy_before: f64,
}

impl PlaneOrSolid for ControlLoop<'_, '_> {
    #[inline(always)]
    fn run<A: Arithmetic, const D: usize>(self, a: A) {
        let Self { pass, block, sum } = self;
        let ControlBlock { force, stiffness, stresses, energy } = block;
        let BodyControl { xi, density } = pass.control;
        for k in 0..force.len() {
            let own = &pass.carried[pass.first + k];
            let sums = pass.of_row::<A, D>(a, pass.first + k);
            let scale = xi * own.volume();
            force[k] = a.scale(scale, sums.force);
            stiffness[k] = xi / density * sums.stiffness;
            let (now, with_modulus_before) = (0.25 * scale * sums.energy, 0.25 * scale * sums.energy_before);
            let last = std::mem::replace(&mut energy[k].0, now);
            sum.stored += now;
            if with_modulus_before > 0.0 {
                // The trapezoidal rule of the leapfrog spends (E_n - E_n+1)/2 s_n s_n+1 beyond the change of energy.
                sum.released += (with_modulus_before - now) * (last / with_modulus_before).sqrt();
            } else {
                sum.released -= now;
            }
            let mut columns = [DVec3::ZERO; 3];
            for axis in 0..D {
                columns[axis] = sums.couple[axis].xyz() * scale;
            }
            let slope = DMat3::from_cols(columns[0], columns[1], columns[2]);
            pass.add_stress(k, &(slope * own.deformation().transpose()), &mut stresses[k]);
        }
    }
}

impl ControlPass<'_> {
    #[inline(always)]
    fn of_row<A: Arithmetic, const D: usize>(&self, a: A, i: usize) -> PairSums<D> {
        let Self { offsets, near, points, carried, .. } = self;
        let (own, place) = (&carried[i], points[i].place);
        let (neighbors, weights) = near.row(offsets[i], i);
        let curvatures = &near.curvatures[offsets[i]..offsets[i] + neighbors.len()];
        let support_squared = self.support * self.support;
        let mut sums = PairSums {
            force: Lanes4::ZERO,
            couple: [Lanes4::ZERO; D],
            stiffness: 0.0,
            energy: 0.0,
            energy_before: 0.0,
        };
        for n in 0..neighbors.len() {
            let j = neighbors[n] as usize;
            let other = &carried[j];
            let arm = a.minus(points[j].place, place);
            let original = a.minus(other.original, own.original);
            let (mut own_guess, mut other_guess) = (Lanes4::ZERO, Lanes4::ZERO);
            for axis in 0..D {
                own_guess = a.scale_add(original.0[axis], own.columns[axis], own_guess);
                other_guess = a.scale_add(original.0[axis], other.columns[axis], other_guess);
            }
            let square = arm.dot3(arm);
            // s over |x| of both.
            let over = 1.0 / square;
            let own_share = own_guess.dot3(arm) * over - 1.0;
            let other_share = other_guess.dot3(arm) * over - 1.0;
            // Pairs that have met on the way.
            let known = (support_squared / original.dot3(original)).min(1.0);
            let volume = other.volume() * known * known;
            let (own_constant, other_constant) = (volume * own.resists(other), volume * other.resists(own));
            let (own_pull, other_pull) = (own_constant * own_share, other_constant * other_share);
            let errors = own_pull * own_share + other_pull * other_share;
            let half = 0.5 * weights[n];
            // From w = -W' / r the slope of the weight is -(W'' + w) / r.
            let slope = half * (2.0 * (own_pull + other_pull) + errors)
                + 0.25 * (curvatures[n] + weights[n]) * errors;
            let guess = a.scale_add(half * own_pull, own_guess, a.scale(half * other_pull, other_guess));
            sums.force = a.plus(sums.force, a.scale_add(-slope, arm, guess));
            for axis in 0..D {
                sums.couple[axis] = a.scale_add(half * own_pull * original.0[axis], arm, sums.couple[axis]);
            }
            let error = weights[n] * volume * own_share * own_share * square;
            sums.stiffness += half * (own_constant + other_constant);
            sums.energy += error * own.resists(other);
            sums.energy_before += error * own.resisted(other);
        }
        sums
    }

    /// Adds V_i times a stress to what neighbours read of row `k`.
    #[inline(always)]
    fn add_stress(&self, k: usize, stress: &DMat3, row: &mut CorrectedStress) {
        let i = self.first + k;
        let volume = self.points[i].place.0[3];
        if volume > 0.0 {
            let stress = *stress * (1.0 / volume);
            let add = corrected(self.divergence, &stress, &self.near.around[i], (self.mass[i].0, volume));
            CorrectedStressRows(std::slice::from_mut(row)).add_scaled(0, 1.0, &add);
        }
    }
}
