//! First pass over pairs: the deformation gradient, then, while a block is in cache, stress and pair stress.
//!
//! `F_i = I + (sum_j V_j w_ij u_ij (x) X_ij) M_i^-1` is the weighted least-squares fit of the current pair vectors
//! (Ganzenmueller 2015, eq. 13, with the correction of eq. 10 written as one inverse; displacements keep the digits of
//! small strains). In plane strain the third row and column are those of the identity.

use glam::{DMat3, DVec3};

use super::bond_terms::{BondEnergy, BondMemory, BondRows, BondTerm};
use super::bonds::Bonds;
use super::cracks::Mark;
use super::damping::{Damping, DampingRows};
use super::edges::EdgeRows;
use super::frame::Frame;
use super::gather::{Gather, MakePairStress};
use super::images::Images;
use super::refit::{self, Refits};
use super::rows::{PairStress, PairStressRows, Site};
use crate::linalg::Sym3;
use crate::materials::{SolidLaw, StateRows, StressRows};
use crate::parallel::{BLOCK, BlockSum, Split, for_each_block, run_hot, run_hot_in};
use crate::world::Velocity;

/// Largest number of bond terms on one body.
pub(super) const MAX_TERMS: usize = 4;

/// What the pass learns of a body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DeformationSum {
    /// Strain energy, J.
    pub strain: f64,
    /// Plastic work of the step, J.
    pub plastic_work: f64,
    /// Work that damping took in the step, J.
    pub damped: f64,
    /// Energy of each bond term, J.
    pub terms: [BondEnergy; MAX_TERMS],
    /// Row with det F <= 0 that comes first of those that resist, counted from one; zero if there is none.
    pub inverted: usize,
}

impl DeformationSum {
    /// All that the bonds of the body hold, J.
    pub fn stored(&self) -> f64 {
        self.strain + self.terms.iter().map(|term| term.stored).sum::<f64>()
    }
}

impl BlockSum for DeformationSum {
    fn add(&mut self, next: &Self) {
        self.strain += next.strain;
        self.plastic_work += next.plastic_work;
        self.damped += next.damped;
        for (sum, next) in self.terms.iter_mut().zip(&next.terms) {
            sum.stored += next.stored;
            sum.released += next.released;
        }
        if self.inverted == 0 {
            self.inverted = next.inverted;
        }
    }
}

/// What the pass writes, cut by rows of one body.
pub(super) struct DeformationRows<'a> {
    pub deformation: &'a mut [DMat3],
    pub stress: &'a mut [DMat3],
    pub pair_stress: &'a mut [PairStress],
    /// `A_i sum_j V_j w_ij X_ij + k_i sum_j V_j w_ij u_ij`, the part of the force that knows no stress but its own.
    pub own_pull: &'a mut [DVec3],
    pub state: StateRows<'a>,
    pub memory: BondMemory<'a>,
    pub damping: DampingRows<'a>,
    pub edges: EdgeRows<'a>,
}

impl Split for DeformationRows<'_> {
    fn rows(&self) -> usize {
        self.deformation.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (deformation, deformation_rest) = self.deformation.split_at_mut(at);
        let (stress, stress_rest) = self.stress.split_at_mut(at);
        let (pair_stress, pair_stress_rest) = self.pair_stress.split_at_mut(at);
        let (own_pull, own_pull_rest) = self.own_pull.split_at_mut(at);
        let (state, state_rest) = self.state.split(at);
        let (memory, memory_rest) = self.memory.split(at);
        let (damping, damping_rest) = self.damping.split(at);
        let (edges, edges_rest) = self.edges.split(at);
        (
            Self { deformation, stress, pair_stress, own_pull, state, memory, damping, edges },
            Self {
                deformation: deformation_rest,
                stress: stress_rest,
                pair_stress: pair_stress_rest,
                own_pull: own_pull_rest,
                state: state_rest,
                memory: memory_rest,
                damping: damping_rest,
                edges: edges_rest,
            },
        )
    }
}

/// The pass over one body.
pub(super) struct DeformationPass<'a> {
    pub bonds: &'a Bonds,
    pub images: &'a Images,
    pub sites: &'a [Site],
    pub law: &'a dyn SolidLaw,
    pub terms: &'a [&'a dyn BondTerm],
    pub frame: &'a Frame,
    /// First row of the body in the phase.
    pub first_row: usize,
    /// Measures of deformation that outlast cuts in the neighbourhood.
    pub refits: &'a Refits,
    /// Which rows have failed; looked at where there are edges.
    pub marks: &'a [Mark],
    pub velocity: &'a [Velocity],
    /// Plane strain.
    pub plane: bool,
    /// Length of the step, s; zero before the first.
    pub dt: f64,
    /// Whether the step is a part of a long one.
    pub is_short: bool,
}

impl DeformationPass<'_> {
    /// Runs the pass over all rows of the body.
    pub fn run(&self, rows: DeformationRows<'_>, sums: &mut Vec<DeformationSum>) -> DeformationSum {
        for_each_block(rows, sums, &|first, block| self.block(self.first_row + first, block))
    }

    fn block(&self, first: usize, rows: DeformationRows<'_>) -> DeformationSum {
        let n = rows.deformation.len();
        let mut gradient = [DMat3::ZERO; BLOCK];
        let mut misfit = [0.0; BLOCK];
        let mut stretch = [DVec3::ZERO; BLOCK];
        let mut volume = [0.0; BLOCK];
        let mut energy = [0.0; BLOCK];
        let mut modulus = [0.0; BLOCK];
        let mut strength = [f64::INFINITY; BLOCK];
        let mut plastic_work = [0.0; BLOCK];
        let (bonds, sites) = (self.bonds, self.sites);
        let gather = Gather {
            bonds,
            sites,
            first,
            deformation: rows.deformation,
            gradient: &mut gradient,
            misfit: &mut misfit,
            stretch: &mut stretch,
            volume: &mut volume,
        };
        run_hot_in(self.plane, gather);
        let (stress, energy, modulus) = (rows.stress, &mut energy[..n], &mut modulus[..n]);
        let refits = self.refits.of_block(first, n);
        refit::to_law(refits, first, rows.deformation, stress);
        self.law.stress(&mut StressRows {
            dt: self.dt,
            deformation: rows.deformation,
            stress: &mut *stress,
            energy: &mut *energy,
            modulus: &mut *modulus,
            strength: &mut strength[..n],
            plastic_work: &mut plastic_work[..n],
            state: rows.state,
        });
        let fitted = |k: usize| DMat3::IDENTITY + gradient[k];
        refit::from_law(refits, first, fitted, rows.deformation, stress);
        let inverse_moment = &bonds.inverse_moment[first..first + n];
        // A particle without a deformation gradient resists nothing: its bonds would hold it against rotation.
        for (modulus, inverse) in modulus.iter_mut().zip(inverse_moment) {
            *modulus = if *inverse == Sym3::ZERO { 0.0 } else { *modulus };
        }
        let mut sum = DeformationSum::default();
        if rows.damping.strain.is_empty() {
            run_hot(MakePairStress { stress, inverse_moment, pair_stress: rows.pair_stress });
        } else {
            let mut damped = [DMat3::ZERO; BLOCK];
            damped[..n].copy_from_slice(stress);
            let damping = Damping {
                elastic: self.law.elastic(),
                dt: self.dt,
                is_short: self.is_short,
                deformation: rows.deformation,
                gradient: &gradient[..n],
                modulus,
                volume: &volume[..n],
            };
            sum.damped = damping.add(rows.damping, &mut damped[..n]);
            let pair_stress = &mut *rows.pair_stress;
            run_hot(MakePairStress { stress: &damped[..n], inverse_moment, pair_stress });
        }
        refit::to_column(refits, first, stress);
        let bond_rows = BondRows {
            deformation: rows.deformation,
            displacement_gradient: &gradient[..n],
            modulus,
            strength: &strength[..n],
            memory: rows.memory,
            misfit: &misfit[..n],
            volume: &volume[..n],
            pair_stress: PairStressRows(rows.pair_stress),
        };
        self.add_terms(bond_rows, rows.edges, &mut sum.terms);
        let completed = rows.pair_stress.iter_mut().zip(rows.own_pull);
        for (k, (pair_stress, own_pull)) in completed.enumerate() {
            pair_stress.complete(self.frame, &sites[first + k]);
            let reach = bonds.reach[first + k];
            *own_pull = pair_stress.times(reach, stretch[k] - self.frame.gradient * reach);
        }
        for k in 0..n {
            sum.strain += energy[k] * volume[k];
            sum.plastic_work += plastic_work[k] * volume[k];
        }
        // What resists nothing, because it has failed, may turn inside out.
        let mut resisting = rows.deformation.iter().zip(&*modulus);
        let inverted = resisting.position(|(f, modulus)| f.determinant() <= 0.0 && *modulus != 0.0);
        sum.inverted = inverted.map_or(0, |k| first + k + 1);
        sum
    }
}
