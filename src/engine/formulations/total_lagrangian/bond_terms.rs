//! The open slots of the hot passes: what is linear in X_ij or x_ij costs nothing per pair.

use std::ops::Range;

use glam::DMat3;

use super::rows::PairStressRows;
use crate::plugin::SimBuilder;
use crate::world::BodySet;

/// A block of particles of one body, after their stress is known and before the pass over pairs that makes the force.
/// All slices have one length. Beside particles that have failed, displacement gradient and error are those of a fit to the neighbours that
/// hold, and what a term adds does not act on those that have failed: no bond across a crack carries a force of a term.
pub struct BondRows<'a> {
    /// Deformation gradient F_i.
    pub deformation: &'a [DMat3],
    /// Displacement gradient H_i = F_i - I, with all digits of a small strain.
    pub displacement_gradient: &'a [DMat3],
    /// Young's modulus E_i as it is now, Pa.
    pub modulus: &'a [f64],
    /// Stress beyond which a particle that has yielded flows, Pa; infinite for all that has not yielded.
    pub strength: &'a [f64],
    /// What terms leave in columns.
    pub memory: BondMemory<'a>,
    /// Error of the mean deformation, `sum_j V_j w_ij |F_i X_ij - x_ij|^2`, m2 times the unit of V w.
    pub misfit: &'a [f64],
    /// Reference volume V_i, m3.
    pub volume: &'a [f64],
    /// Pair stress A_i and bond stiffness k_i, to be added to.
    pub pair_stress: PairStressRows<'a>,
}

impl BondRows<'_> {
    /// Some of the rows.
    pub(super) fn part(&mut self, rows: Range<usize>) -> BondRows<'_> {
        BondRows {
            deformation: &self.deformation[rows.clone()],
            displacement_gradient: &self.displacement_gradient[rows.clone()],
            modulus: &self.modulus[rows.clone()],
            strength: &self.strength[rows.clone()],
            memory: self.memory.part(rows.clone()),
            misfit: &self.misfit[rows.clone()],
            volume: &self.volume[rows.clone()],
            pair_stress: PairStressRows(&mut self.pair_stress.0[rows]),
        }
    }
}

/// What terms leave in columns: modulus and error of the mean deformation of the last step, for terms that become softer on the way, and the fit
/// for pair terms. A slice is empty where no plugin has added its column.
#[derive(Default)]
pub struct BondMemory<'a> {
    /// Modulus, Pa: column [`HourglassModulus`](crate::world::HourglassModulus); zero before the first step.
    pub modulus: &'a mut [f64],
    /// Error of the mean deformation: column [`HourglassMisfit`](crate::world::HourglassMisfit).
    pub misfit: &'a mut [f64],
    /// Deformation gradient that fits the neighbours that hold: column [`HourglassGradient`](crate::world::HourglassGradient).
    pub gradient: &'a mut [DMat3],
}

impl BondMemory<'_> {
    /// Some of the rows.
    fn part(&mut self, rows: Range<usize>) -> BondMemory<'_> {
        let Self { modulus, misfit, gradient } = self;
        BondMemory {
            modulus: modulus.get_mut(rows.clone()).unwrap_or_default(),
            misfit: misfit.get_mut(rows.clone()).unwrap_or_default(),
            gradient: gradient.get_mut(rows).unwrap_or_default(),
        }
    }

    /// The rows before and from `at`.
    pub(super) fn split(self, at: usize) -> (Self, Self) {
        let (modulus, modulus_rest) = self.modulus.split_at_mut(at.min(self.modulus.len()));
        let (misfit, misfit_rest) = self.misfit.split_at_mut(at.min(self.misfit.len()));
        let (gradient, gradient_rest) = self.gradient.split_at_mut(at.min(self.gradient.len()));
        (
            Self { modulus, misfit, gradient },
            Self { modulus: modulus_rest, misfit: misfit_rest, gradient: gradient_rest },
        )
    }
}

/// What a bond term tells of the energy of a block, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BondEnergy {
    /// Energy that it stores now.
    pub stored: f64,
    /// Energy that it has given up in this step without work, because it has become softer.
    pub released: f64,
}

/// A force term of total-Lagrangian bodies that is linear in the pair vectors: it adds to the pair stress A_i and to
/// the bond stiffness k_i of every particle, and the engine's own pass over pairs applies it (see
/// [`PairStress`](super::PairStress)).
pub trait BondTerm: Send + Sync + 'static {
    /// Adds the term to a block; returns its energy there.
    fn add(&self, rows: &mut BondRows<'_>) -> BondEnergy;

    /// The stiffness that the term gives a bond, as a multiple of the modulus E_i: k_i = factor E_i. The stable time
    /// step follows from it.
    fn stiffness_factor(&self) -> f64;
}

/// A bond term with the bodies it acts on; plugins add it with [`SimBuilder::extend`].
pub struct BodyBondTerm {
    /// Bodies.
    pub bodies: BodySet,
    /// Account of the energy ledger that holds what the term stores; none if it stores nothing.
    pub account: Option<String>,
    /// Account of the energy that the term has given up without work; none if it never does.
    pub released: Option<String>,
    /// The term.
    pub term: Box<dyn BondTerm>,
}

impl SimBuilder<'_> {
    /// Adds a force term that is linear in the pair vectors to total-Lagrangian bodies. The energy that it stores goes
    /// to the account of that name.
    pub fn add_bond_term(&mut self, bodies: BodySet, account: &str, term: impl BondTerm) {
        let account = Some(account.to_owned());
        self.extend(BodyBondTerm { bodies, account, released: None, term: Box::new(term) });
    }
}
