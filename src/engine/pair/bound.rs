//! Terms bound to the columns of a phase for the length of a pass: a chain on the stack, without allocation.

use super::read::ReadSet;
use super::row::PairRow;
use super::term::{PairReads, PairTerm, Rates, RowRates};
use crate::parallel::{Arithmetic, HotLoop, run_hot_on};
use crate::schedule::{Access, Mode};
use crate::world::{Column, MissingColumn, PhaseView, Velocity};

/// A term that is bound to its columns.
pub(super) trait RowTerm: Sync {
    /// The contributions of all neighbours of row i.
    fn row(&self, i: usize, row: &PairRow, plane: bool) -> RowRates;
}

struct Bound<'a, T: PairTerm> {
    term: &'a T,
    of_i: <T::ReadI as ReadSet>::Slices<'a>,
    of_j: <T::ReadJ as ReadSet>::Slices<'a>,
}

impl<T: PairTerm> RowTerm for Bound<'_, T> {
    fn row(&self, i: usize, row: &PairRow, plane: bool) -> RowRates {
        run_hot_on(plane, Row { bound: self, i, row })
    }
}

/// The neighbours of one particle, with the pair function inlined.
struct Row<'r, 'a, T: PairTerm> {
    bound: &'r Bound<'a, T>,
    i: usize,
    row: &'r PairRow,
}

impl<T: PairTerm> HotLoop for Row<'_, '_, T> {
    type Output = RowRates;

    #[inline(always)]
    fn run<A: Arithmetic>(self, a: A) -> RowRates {
        if self.row.is_plain() { self.sum::<A, true>(a) } else { self.sum::<A, false>(a) }
    }
}

impl<T: PairTerm> Row<'_, '_, T> {
    /// The sum over all neighbours; `PLAIN` where none is an image and x_ij is all there is.
    #[inline(always)]
    fn sum<A: Arithmetic, const PLAIN: bool>(&self, a: A) -> RowRates {
        let Bound { term, of_i, of_j } = *self.bound;
        let i = T::ReadI::four(a, of_i, [self.i as u32; 4], None);
        let mut rates = Rates::zero(a);
        for k in 0..self.row.fours() {
            let (rows, signs) = self.row.rows::<PLAIN>(k);
            let j = T::ReadJ::four(a, of_j, rows, signs);
            term.pair(&self.row.pair::<A, PLAIN>(a, k), i, j, &mut rates);
        }
        rates.sum()
    }
}

/// The bound terms of a pass, the last one first.
#[derive(Clone, Copy)]
pub(super) struct Chain<'c> {
    term: &'c dyn RowTerm,
    before: Option<&'c Chain<'c>>,
}

impl Chain<'_> {
    /// Calls every term once with the row; `rates` has one entry a term.
    pub fn row(&self, i: usize, row: &PairRow, plane: bool, rates: &mut [RowRates]) {
        let Some((own, rest)) = rates.split_last_mut() else { return };
        if let Some(before) = self.before {
            before.row(i, row, plane, rest);
        }
        *own = self.term.row(i, row, plane);
    }
}

/// What goes on once all terms are bound.
type Continue<'r> = &'r mut dyn FnMut(&Chain<'_>);

/// A pair term whose type is erased.
pub(super) trait ErasedTerm: Send + Sync {
    /// Columns it reads.
    fn access(&self) -> Vec<Access>;
    /// What it reads of a pair.
    fn reads(&self) -> PairReads;
    /// Whether it gives density rates.
    fn changes_density(&self) -> bool;
    /// Borrows the columns, adds the term to the chain and goes on with it.
    fn bind(
        &self,
        phase: &PhaseView<'_>,
        before: Option<&Chain<'_>>,
        go_on: &mut dyn FnMut(&Chain<'_>) -> Result<(), MissingColumn>,
    ) -> Result<(), MissingColumn>;
}

impl<T: PairTerm> ErasedTerm for T {
    fn access(&self) -> Vec<Access> {
        let mut access = T::ReadI::access();
        if T::READS_VELOCITY {
            access.push(Access { column: Velocity::NAME, mode: Mode::Reads });
        }
        access.extend(T::ReadJ::access());
        access
    }

    fn reads(&self) -> PairReads {
        PairReads { kernel: T::READS_KERNEL, velocity: T::READS_VELOCITY }
    }

    fn changes_density(&self) -> bool {
        T::CHANGES_DENSITY
    }

    fn bind(
        &self,
        phase: &PhaseView<'_>,
        before: Option<&Chain<'_>>,
        go_on: &mut dyn FnMut(&Chain<'_>) -> Result<(), MissingColumn>,
    ) -> Result<(), MissingColumn> {
        let (of_i, of_j) = (T::ReadI::guards(phase)?, T::ReadJ::guards(phase)?);
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
