//! Terms of plugins that are linear in X_ij or u_ij. They fold into the stress of a particle, `(A_i + A_j)
//! X_ij + (k_i + k_j) u_ij` per pair with the weight of the formulation, and cost nothing per pair.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::DMat3;

use super::corrected_stress::CorrectedStressRows;
use crate::parallel::split_by_rows;
use crate::plugin::SimBuilder;
use crate::world::BodySet;

/// A block of particles of one body, after their stress is known and before the pass over pairs that computes
/// the force. All slices have one length. Beside failed particles, displacement gradient and residual are
/// those of a fit to the intact neighbours, and terms do not act on failed ones: no bond across a crack
/// carries a force of a term.
pub struct FoldedRows<'a> {
    /// Deformation gradient F_i.
    pub deformation: &'a [DMat3],
    /// Displacement gradient H_i = F_i - I, with all digits of a small strain.
    pub displacement_gradient: &'a [DMat3],
    /// Current Young's modulus E_i, Pa.
    pub modulus: &'a [f64],
    /// Resistance of a particle that has yielded, Pa, infinite for others: its flow stress, and at least a
    /// fifth of the pressure but for Eulerian bodies with spherical supports.
    pub strength: &'a [f64],
    /// Values of terms stored in columns.
    pub memory: FoldedMemory<'a>,
    /// Hourglass residual, `sum_j V_j w_ij |F_i X_ij - x_ij|^2`, m2 times the unit of V w.
    pub residual: &'a [f64],
    /// Reference volume V_i, m3.
    pub volume: &'a [f64],
    /// Corrected stress A_i and bond stiffness k_i, to be added to.
    pub stress: CorrectedStressRows<'a>,
}

impl FoldedRows<'_> {
    /// Some of the rows.
    pub fn part(&mut self, rows: Range<usize>) -> FoldedRows<'_> {
        FoldedRows {
            deformation: &self.deformation[rows.clone()],
            displacement_gradient: &self.displacement_gradient[rows.clone()],
            modulus: &self.modulus[rows.clone()],
            strength: &self.strength[rows.clone()],
            memory: self.memory.part(rows.clone()),
            residual: &self.residual[rows.clone()],
            volume: &self.volume[rows.clone()],
            stress: CorrectedStressRows(&mut self.stress.0[rows]),
        }
    }
}

/// Values of terms stored in columns: modulus and hourglass residual of the last step, for terms that soften,
/// and the fit for pair terms. A slice is empty where no plugin has added its column.
#[derive(Default)]
pub struct FoldedMemory<'a> {
    /// Modulus, Pa: column [`HourglassModulus`](crate::world::HourglassModulus); zero before the first step.
    pub modulus: &'a mut [f64],
    /// Hourglass residual: column [`HourglassResidual`](crate::world::HourglassResidual).
    pub residual: &'a mut [f64],
    /// Deformation gradient fitted to the intact neighbours: column
    /// [`HourglassGradient`](crate::world::HourglassGradient).
    pub gradient: &'a mut [DMat3],
}

impl FoldedMemory<'_> {
    /// Some of the rows.
    pub(super) fn part(&mut self, rows: Range<usize>) -> FoldedMemory<'_> {
        let Self { modulus, residual, gradient } = self;
        FoldedMemory {
            modulus: modulus.get_mut(rows.clone()).unwrap_or_default(),
            residual: residual.get_mut(rows.clone()).unwrap_or_default(),
            gradient: gradient.get_mut(rows).unwrap_or_default(),
        }
    }
}

split_by_rows!(FoldedMemory { modulus, residual, gradient });

/// Energy of a folded term in a block, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FoldedEnergy {
    /// Energy that it stores now.
    pub stored: f64,
    /// Energy released in this step without work, by softening.
    pub released: f64,
}

/// A force term of solids that is linear in the pair vectors: it adds to the corrected stress A_i and to the
/// bond stiffness k_i of every particle, and the formulation's own pass over pairs applies it (see
/// [`CorrectedStress`](super::CorrectedStress)).
pub trait FoldedTerm: Send + Sync + 'static {
    /// Adds the term to a block; returns its energy there.
    fn add(&self, rows: &mut FoldedRows<'_>) -> FoldedEnergy;

    /// The stiffness that the term gives a bond, as a multiple of the modulus E_i: k_i = factor E_i. The
    /// stable time step follows from it.
    fn stiffness_factor(&self) -> f64;

    /// Whether it adds nothing to the stress, and only stores its input in columns. Formulations without a
    /// reference configuration accept no other.
    fn only_looks(&self) -> bool {
        false
    }
}

/// A folded term of a plugin, for bodies.
pub struct FoldedTermOfBodies {
    /// Account of the stored energy of the term; none if it stores nothing.
    pub account: Option<String>,
    /// Account of the energy released without work; none if it never is.
    pub released: Option<String>,
    /// The term.
    pub term: Box<dyn FoldedTerm>,
}

impl FoldedTermOfBodies {
    /// Adds the term to bodies. A body whose formulation does not accept such terms is an error of the scene.
    pub fn add(self, bodies: BodySet, sim: &mut SimBuilder<'_>) {
        sim.extend_bodies(bodies, "a term that folds into the internal force", self);
    }
}

impl SimBuilder<'_> {
    /// Adds a force term that is linear in the pair vectors to bodies. The energy that it stores goes to the
    /// account of that name.
    pub fn add_folded_term(&mut self, bodies: BodySet, account: &str, term: impl FoldedTerm) {
        let account = Some(account.to_owned());
        FoldedTermOfBodies { account, released: None, term: Box::new(term) }.add(bodies, self);
    }
}
