//! The columns that a pair term reads: a tuple of columns, borrowed as slices for the whole pass.

use std::ops::Range;

use glam::DVec3;

use crate::schedule::{Access, Mode};
use crate::world::{Column, MissingColumn, PhaseView};

/// A tuple of columns that is read row by row.
pub trait ReadSet: Copy + Send + Sync + 'static {
    /// The guards that borrow the columns.
    type Guards<'g>;
    /// The columns as slices.
    type Slices<'s>: Copy + Send + Sync;

    /// Names of the columns.
    fn access() -> Vec<Access>;
    /// Borrows the columns.
    fn guards<'g>(phase: &PhaseView<'g>) -> Result<Self::Guards<'g>, MissingColumn>;
    /// The borrowed columns as slices of the given rows.
    fn slices<'s>(guards: &'s Self::Guards<'_>, rows: Range<usize>) -> Self::Slices<'s>;
    /// The values of one row of the slices.
    fn at(slices: Self::Slices<'_>, row: usize) -> Self;
    /// The values of the mirror image of a particle; `signs` are those of its axes.
    fn mirrored(self, signs: DVec3) -> Self;
}

impl ReadSet for () {
    type Guards<'g> = ();
    type Slices<'s> = ();

    fn access() -> Vec<Access> {
        Vec::new()
    }

    fn guards<'g>(_: &PhaseView<'g>) -> Result<(), MissingColumn> {
        Ok(())
    }

    fn slices((): &(), _: Range<usize>) {}

    #[inline(always)]
    fn at((): (), _: usize) {}

    #[inline(always)]
    fn mirrored(self, _: DVec3) {}
}

macro_rules! read_set {
    ($($name:ident $k:tt),+) => {
        impl<$($name: Column),+> ReadSet for ($($name,)+) {
            type Guards<'g> = ($(hecs::ArchetypeColumn<'g, $name>,)+);
            type Slices<'s> = ($(&'s [$name],)+);

            fn access() -> Vec<Access> {
                vec![$(Access { column: $name::NAME, mode: Mode::Reads }),+]
            }

            fn guards<'g>(phase: &PhaseView<'g>) -> Result<Self::Guards<'g>, MissingColumn> {
                Ok(($(phase.read::<$name>()?,)+))
            }

            fn slices<'s>(guards: &'s Self::Guards<'_>, rows: Range<usize>) -> Self::Slices<'s> {
                ($(&guards.$k[rows.clone()],)+)
            }

            #[inline(always)]
            fn at(slices: Self::Slices<'_>, row: usize) -> Self {
                ($(slices.$k[row],)+)
            }

            #[inline(always)]
            fn mirrored(self, signs: DVec3) -> Self {
                ($(self.$k.mirrored(signs),)+)
            }
        }
    };
}
read_set!(A 0);
read_set!(A 0, B 1);
read_set!(A 0, B 1, C 2);
read_set!(A 0, B 1, C 2, D 3);
read_set!(A 0, B 1, C 2, D 3, E 4);
