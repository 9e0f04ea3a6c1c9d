//! The columns that a pair term reads: a tuple of columns, borrowed as slices for the whole pass.

use std::ops::Range;

use glam::DVec3;

use crate::parallel::Arithmetic;
use crate::schedule::{Access, Mode};
use crate::world::{Column, MissingColumn, PhaseView, Value};

/// The values of four rows of a set of columns.
pub type FourOf<S, A> = <S as ReadSet>::Four<A>;

/// A tuple of columns that is read row by row.
pub trait ReadSet: Copy + Send + Sync + 'static {
    /// The guards that borrow the columns.
    type Guards<'g>;
    /// The columns as slices.
    type Slices<'s>: Copy + Send + Sync;
    /// The values of four rows, as [`Value::Four`](crate::world::Value::Four) says: vectors, numbers, matrices.
    type Four<A: Arithmetic>: Copy;

    /// Names of the columns.
    fn access() -> Vec<Access>;
    /// Borrows the columns.
    fn guards<'g>(phase: &PhaseView<'g>) -> Result<Self::Guards<'g>, MissingColumn>;
    /// The borrowed columns as slices of the given rows.
    fn slices<'s>(guards: &'s Self::Guards<'_>, rows: Range<usize>) -> Self::Slices<'s>;
    /// The values of four rows of the slices; `signs` are those of the axes of mirror images.
    fn four<A: Arithmetic>(
        a: A,
        slices: Self::Slices<'_>,
        rows: [u32; 4],
        signs: Option<&[DVec3; 4]>,
    ) -> Self::Four<A>;
}

impl ReadSet for () {
    type Guards<'g> = ();
    type Slices<'s> = ();
    type Four<A: Arithmetic> = ();

    fn access() -> Vec<Access> {
        Vec::new()
    }

    fn guards<'g>(_: &PhaseView<'g>) -> Result<(), MissingColumn> {
        Ok(())
    }

    fn slices((): &(), _: Range<usize>) {}

    #[inline(always)]
    fn four<A: Arithmetic>(_: A, (): (), _: [u32; 4], _: Option<&[DVec3; 4]>) {}
}

#[inline(always)]
fn four_of<C: Column, A: Arithmetic>(
    a: A,
    column: &[C],
    [j, k, l, m]: [u32; 4],
    signs: Option<&[DVec3; 4]>,
) -> <C::Value as Value>::Four<A> {
    let mut four = [column[j as usize], column[k as usize], column[l as usize], column[m as usize]];
    if let Some(signs) = signs {
        four = [
            four[0].mirrored(signs[0]),
            four[1].mirrored(signs[1]),
            four[2].mirrored(signs[2]),
            four[3].mirrored(signs[3]),
        ];
    }
    C::Value::four(a, [*four[0].value(), *four[1].value(), *four[2].value(), *four[3].value()])
}

macro_rules! read_set {
    ($($name:ident $k:tt),+) => {
        impl<$($name: Column),+> ReadSet for ($($name,)+) {
            type Guards<'g> = ($(hecs::ArchetypeColumn<'g, $name>,)+);
            type Slices<'s> = ($(&'s [$name],)+);
            type Four<A: Arithmetic> = ($(<$name::Value as Value>::Four<A>,)+);

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
            fn four<A: Arithmetic>(
                a: A,
                slices: Self::Slices<'_>,
                rows: [u32; 4],
                signs: Option<&[DVec3; 4]>,
            ) -> Self::Four<A> {
                ($(four_of(a, slices.$k, rows, signs),)+)
            }
        }
    };
}
read_set!(P 0);
read_set!(P 0, Q 1);
read_set!(P 0, Q 1, R 2);
read_set!(P 0, Q 1, R 2, S 3);
read_set!(P 0, Q 1, R 2, S 3, T 4);
