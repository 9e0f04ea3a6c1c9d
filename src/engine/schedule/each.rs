//! Rows of several columns at once, for systems that are a function of one particle.

use std::marker::PhantomData;
use std::ops::Range;

use crate::parallel::{BlockSum, Split, sum_over_blocks};
use crate::world::{Access, Column, MissingColumn, Mode, PhaseView};

/// One column of a row: `&C` or `&mut C`.
pub trait RowColumn {
    /// The guard that borrows the column.
    type Guard<'g>;
    /// The column as a slice that can be cut for threads.
    type Slice<'s>: Split;
    /// One row of it.
    type Item<'r>;

    /// Declared access.
    fn access() -> Access;
    /// Borrows the column.
    fn guard<'g>(phase: &PhaseView<'g>) -> Result<Self::Guard<'g>, MissingColumn>;
    /// The rows of the borrowed column.
    fn slice<'s>(guard: &'s mut Self::Guard<'_>, rows: Range<usize>) -> Self::Slice<'s>;
    /// Row `k` of the slice.
    fn item<'r>(slice: &'r mut Self::Slice<'_>, k: usize) -> Self::Item<'r>;
}

impl<C: Column> RowColumn for &C {
    type Guard<'g> = hecs::ArchetypeColumn<'g, C>;
    type Slice<'s> = &'s [C];
    type Item<'r> = &'r C;

    fn access() -> Access {
        Access { column: C::NAME, mode: Mode::Reads }
    }

    fn guard<'g>(phase: &PhaseView<'g>) -> Result<Self::Guard<'g>, MissingColumn> {
        phase.read()
    }

    fn slice<'s>(guard: &'s mut Self::Guard<'_>, rows: Range<usize>) -> Self::Slice<'s> {
        &(**guard)[rows]
    }

    fn item<'r>(slice: &'r mut Self::Slice<'_>, k: usize) -> Self::Item<'r> {
        &slice[k]
    }
}

impl<C: Column> RowColumn for &mut C {
    type Guard<'g> = hecs::ArchetypeColumnMut<'g, C>;
    type Slice<'s> = &'s mut [C];
    type Item<'r> = &'r mut C;

    fn access() -> Access {
        Access { column: C::NAME, mode: Mode::Writes }
    }

    fn guard<'g>(phase: &PhaseView<'g>) -> Result<Self::Guard<'g>, MissingColumn> {
        phase.write()
    }

    fn slice<'s>(guard: &'s mut Self::Guard<'_>, rows: Range<usize>) -> Self::Slice<'s> {
        &mut (**guard)[rows]
    }

    fn item<'r>(slice: &'r mut Self::Slice<'_>, k: usize) -> Self::Item<'r> {
        &mut slice[k]
    }
}

/// Column `C` as an accumulator: the row is a `&mut C` that the system only adds to, so that it needs no
/// stated order among the others that add to the column.
pub struct Adds<C>(PhantomData<C>);

impl<C: Column> RowColumn for Adds<C> {
    type Guard<'g> = hecs::ArchetypeColumnMut<'g, C>;
    type Slice<'s> = &'s mut [C];
    type Item<'r> = &'r mut C;

    fn access() -> Access {
        Access { column: C::NAME, mode: Mode::Adds }
    }

    fn guard<'g>(phase: &PhaseView<'g>) -> Result<Self::Guard<'g>, MissingColumn> {
        phase.write()
    }

    fn slice<'s>(guard: &'s mut Self::Guard<'_>, rows: Range<usize>) -> Self::Slice<'s> {
        &mut (**guard)[rows]
    }

    fn item<'r>(slice: &'r mut Self::Slice<'_>, k: usize) -> Self::Item<'r> {
        &mut slice[k]
    }
}

/// A tuple of up to five columns: `&C` to read, `&mut C` to write, [`Adds<C>`](Adds) to add to.
pub trait EachRow {
    /// One row of the columns.
    type Row<'r>;

    /// Declares the access to every column.
    fn declare(access: &mut Vec<Access>);
    /// Calls `f` for every row, in parallel, and returns the sum of what it returns, in a fixed order.
    fn for_each<R: BlockSum>(
        phase: &PhaseView<'_>,
        rows: Range<usize>,
        f: &(impl for<'r> Fn(Self::Row<'r>) -> R + Sync),
    ) -> Result<R, MissingColumn>;
}

macro_rules! each_row {
    ($($name:ident $k:tt),+) => {
        impl<$($name: RowColumn),+> EachRow for ($($name,)+) {
            type Row<'r> = ($($name::Item<'r>,)+);

            fn declare(access: &mut Vec<Access>) {
                access.extend([$($name::access()),+]);
            }

            fn for_each<R: BlockSum>(
                phase: &PhaseView<'_>,
                rows: Range<usize>,
                f: &(impl for<'r> Fn(Self::Row<'r>) -> R + Sync),
            ) -> Result<R, MissingColumn> {
                let mut guards = ($($name::guard(phase)?,)+);
                let slices = ($($name::slice(&mut guards.$k, rows.clone()),)+);
                let body = |_, mut block: ($($name::Slice<'_>,)+)| {
                    let mut sum = R::default();
                    for k in 0..block.rows() {
                        sum.add(&f(($($name::item(&mut block.$k, k),)+)));
                    }
                    sum
                };
                Ok(sum_over_blocks(slices, &body))
            }
        }
    };
}
each_row!(A 0);
each_row!(A 0, B 1);
each_row!(A 0, B 1, C 2);
each_row!(A 0, B 1, C 2, D 3);
each_row!(A 0, B 1, C 2, D 3, E 4);
