//! Terms bound to the columns of a phase for the length of a pass: a chain on the stack, without allocation.

use glam::DVec3;

use super::batch::{Extras, MAX_ROWS, PairBatch};
use super::block::{BlockPairs, TermSums};
use super::rate_bounds::RateBounds;
use super::read::ReadSet;
use super::term::{PairReads, PairTerm, Rates};
use crate::parallel::{BlockLoop, EightLanes, FourLanes, HotLoop, run_blocks_on, run_hot_on};
use crate::schedule::{Access, Mode};
use crate::world::{DensityRate, Force, MissingColumn, PhaseView, ViscousPower};

/// A term that is bound to its columns.
pub(super) trait RowTerm: Sync {
    /// Adds the contributions of all neighbours of the rows of a batch, the first of which is row `first` of
    /// the phase.
    fn rows(&self, first: usize, batch: &PairBatch, plane: bool, out: RowsOut<'_>);

    /// Adds the contributions of some neighbours of a block.
    fn block(&self, pairs: &BlockPairs, plane: bool, sums: &mut TermSums);
}

/// Output of a term for the rows of a batch.
pub(super) struct RowsOut<'a> {
    /// Force of this term on each particle, among those of all terms.
    pub by_term: &'a mut [DVec3],
    /// Which of these is that of this term.
    pub term: usize,
    /// Number of terms.
    pub terms: usize,
    /// Force of all terms.
    pub total: &'a mut [Force],
    /// Density rates of all terms; empty where the phase has none.
    pub density: &'a mut [DensityRate],
    /// Heat of all terms, W; empty where the phase has none.
    pub heat: &'a mut [ViscousPower],
    /// Rates that limit the step.
    pub fastest: &'a mut [RateBounds; MAX_ROWS],
}

struct Bound<'a, T: PairTerm> {
    term: &'a T,
    of_i: <T::ReadI as ReadSet>::Slices<'a>,
    of_j: <T::ReadJ as ReadSet>::Slices<'a>,
}

impl<T: PairTerm> RowTerm for Bound<'_, T> {
    fn rows(&self, first: usize, batch: &PairBatch, plane: bool, out: RowsOut<'_>) {
        run_hot_on(plane, BoundRows { bound: self, first, batch, out });
    }

    fn block(&self, pairs: &BlockPairs, plane: bool, sums: &mut TermSums) {
        // Blocks are of fluids, which are not given such a term.
        if !T::NEEDS_REFERENCE {
            run_blocks_on(plane, OneBlock { bound: self, pairs, sums });
        }
    }
}

/// Some neighbours of a block, with the pair function inlined.
struct OneBlock<'r, 'a, T: PairTerm> {
    bound: &'r Bound<'a, T>,
    pairs: &'r BlockPairs,
    sums: &'r mut TermSums,
}

impl<T: PairTerm> BlockLoop for OneBlock<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        let Bound { term, of_i, of_j } = *self.bound;
        let base = self.pairs.rows[0];
        let i = T::ReadI::eight(a, of_i, &self.pairs.rows, base);
        let mut rates = self.sums.rates(a);
        let shared = self.pairs.shared(a);
        for pair in self.pairs.pairs() {
            let j = T::ReadJ::same(a, of_j, pair.row, base);
            term.pair(&shared.with(a, pair), i, j, &mut rates);
        }
        self.sums.keep(&rates);
    }
}

/// The neighbours of some particles, with the pair function inlined.
struct BoundRows<'r, 'a, T: PairTerm> {
    bound: &'r Bound<'a, T>,
    first: usize,
    batch: &'r PairBatch,
    out: RowsOut<'r>,
}

impl<T: PairTerm> HotLoop for BoundRows<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Extras { reference, mirrors, supports, .. } = self.batch.extras();
        let alike = !(mirrors || supports);
        if T::NEEDS_REFERENCE {
            if alike {
                self.add::<A, false, true>(a)
            } else {
                self.add::<A, false, false>(a)
            }
            return;
        }
        match (reference, alike) {
            (false, true) => self.add::<A, true, true>(a),
            (true, true) => self.add::<A, false, true>(a),
            (false, false) => self.add::<A, true, false>(a),
            (true, false) => self.add::<A, false, false>(a),
        }
    }
}

impl<T: PairTerm> BoundRows<'_, '_, T> {
    /// Adds up the neighbours; `PLAIN` without reference vectors, `ALIKE` where none is an image and all have
    /// one support radius.
    #[inline(always)]
    fn add<A: FourLanes, const PLAIN: bool, const ALIKE: bool>(self, a: A) {
        let Bound { term, of_i, of_j } = *self.bound;
        let RowsOut { by_term, term: own, terms, total, density, heat, fastest } = self.out;
        for r in 0..self.batch.rows() {
            let row = self.batch.row(r);
            let i = T::ReadI::four(a, of_i, [(self.first + r) as u32; 4], None);
            let mut rates = Rates::zero(a);
            for k in 0..row.fours() {
                let (rows, signs) = row.rows::<ALIKE>(k);
                let j = T::ReadJ::four(a, of_j, rows, signs);
                term.pair(&row.pair::<A, PLAIN, ALIKE>(a, k), i, j, &mut rates);
            }
            let rates = rates.sum();
            by_term[terms * r + own] = rates.force;
            total[r].0 += rates.force;
            if T::CHANGES_DENSITY
                && let Some(density) = density.get_mut(r)
            {
                density.0 += rates.density;
            }
            if T::HEATS
                && let Some(heat) = heat.get_mut(r)
            {
                heat.0 += rates.heat;
            }
            fastest[r].damping += rates.damping;
            fastest[r].stiffness += rates.stiffness;
        }
    }
}

/// The bound terms of a pass, the last one first.
#[derive(Clone, Copy)]
pub(super) struct Chain<'c> {
    term: &'c dyn RowTerm,
    before: Option<&'c Chain<'c>>,
}

impl Chain<'_> {
    /// Runs every term, the last of which is `out.term`, on the batch.
    pub fn rows(&self, first: usize, batch: &PairBatch, plane: bool, out: RowsOut<'_>) {
        let RowsOut { by_term, term, terms, total, density, heat, fastest } = out;
        if let Some(before) = self.before {
            let out = RowsOut {
                by_term: &mut *by_term,
                term: term - 1,
                terms,
                total: &mut *total,
                density: &mut *density,
                heat: &mut *heat,
                fastest: &mut *fastest,
            };
            before.rows(first, batch, plane, out);
        }
        self.term.rows(first, batch, plane, RowsOut { by_term, term, terms, total, density, heat, fastest });
    }

    /// Runs every term on some neighbours of a block; `sums` has one entry for each.
    pub fn block(&self, pairs: &BlockPairs, plane: bool, sums: &mut [TermSums]) {
        let Some((own, rest)) = sums.split_last_mut() else { return };
        if let Some(before) = self.before {
            before.block(pairs, plane, rest);
        }
        self.term.block(pairs, plane, own);
    }
}

/// Continuation once all terms are bound.
type Continue<'r> = &'r mut dyn FnMut(&Chain<'_>);

/// A pair term whose type is erased.
pub(super) trait ErasedTerm: Send + Sync {
    /// Columns it reads, those of neighbours as such; not the relative velocity, which whoever runs the term
    /// gives.
    fn access(&self) -> Vec<Access>;
    /// Reads of a pair.
    fn reads(&self) -> PairReads;
    /// Whether it gives density rates.
    fn changes_density(&self) -> bool;
    /// Whether it is for bodies with reference pair vectors alone.
    fn needs_reference(&self) -> bool;
    /// Borrows the columns, adds the term to the chain and continues with it.
    fn bind(
        &self,
        phase: &PhaseView<'_>,
        before: Option<&Chain<'_>>,
        go_on: &mut dyn FnMut(&Chain<'_>) -> Result<(), MissingColumn>,
    ) -> Result<(), MissingColumn>;
}

impl<T: PairTerm> ErasedTerm for T {
    fn access(&self) -> Vec<Access> {
        let of_j = T::ReadJ::access();
        let is_alone = |own: &Access| of_j.iter().all(|near| near.column != own.column);
        let mut access: Vec<Access> = T::ReadI::access().into_iter().filter(is_alone).collect();
        access.extend(of_j.iter().map(|near| Access { mode: Mode::ReadsNear, ..*near }));
        access
    }

    fn reads(&self) -> PairReads {
        PairReads { kernel: T::READS_KERNEL, velocity: T::READS_VELOCITY }
    }

    fn changes_density(&self) -> bool {
        T::CHANGES_DENSITY
    }

    fn needs_reference(&self) -> bool {
        T::NEEDS_REFERENCE
    }

    fn bind(
        &self,
        phase: &PhaseView<'_>,
        before: Option<&Chain<'_>>,
        go_on: &mut dyn FnMut(&Chain<'_>) -> Result<(), MissingColumn>,
    ) -> Result<(), MissingColumn> {
        let (of_i, of_j) = (T::ReadI::guards(phase, Mode::Reads)?, T::ReadJ::guards(phase, Mode::ReadsNear)?);
        let rows = 0..phase.len();
        let bound = Bound {
            term: self,
            of_i: T::ReadI::slices(&of_i, rows.clone()),
            of_j: T::ReadJ::slices(&of_j, rows),
        };
        go_on(&Chain { term: &bound, before })
    }
}

/// Binds all terms, and calls `run` with the chain of them.
pub(super) fn bind_all(
    terms: &[&dyn ErasedTerm],
    phase: &PhaseView<'_>,
    before: Option<&Chain<'_>>,
    run: Continue<'_>,
) -> Result<(), MissingColumn> {
    let Some((first, rest)) = terms.split_first() else {
        if let Some(chain) = before {
            run(chain);
        }
        return Ok(());
    };
    first.bind(phase, before, &mut |chain| bind_all(rest, phase, Some(chain), run))
}
