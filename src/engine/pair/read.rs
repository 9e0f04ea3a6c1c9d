//! The columns that a pair term reads: a tuple of columns, borrowed as slices for the whole pass.

use std::ops::Range;

use glam::DVec3;

use std::marker::PhantomData;

use crate::parallel::{Arithmetic, EIGHT, EightLanes, FourLanes, Lanes8};
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
    /// The values of four rows, as [`Value::Four`] says: vectors, numbers,
    /// matrices.
    type Four<A: Arithmetic>: Copy;

    /// Names of the columns.
    fn access() -> Vec<Access>;
    /// Borrows the columns, for reading own rows or those of neighbours too.
    fn guards<'g>(phase: &PhaseView<'g>, mode: Mode) -> Result<Self::Guards<'g>, MissingColumn>;
    /// The borrowed columns as slices of the given rows.
    fn slices<'s>(guards: &'s Self::Guards<'_>, rows: Range<usize>) -> Self::Slices<'s>;
    /// The values of four rows of the slices; `signs` are those of the axes of mirror images.
    fn four<A: FourLanes>(
        a: A,
        slices: Self::Slices<'_>,
        rows: [u32; 4],
        signs: Option<&[DVec3; 4]>,
    ) -> Self::Four<A>;
    /// The values of eight rows; those of [`Relative`] columns less the value of the row `base`.
    fn eight<A: EightLanes>(a: A, slices: Self::Slices<'_>, rows: &[u32; EIGHT], base: u32) -> Self::Four<A>;
    /// The values of one row in all lanes, like those of [`ReadSet::eight`].
    fn same<A: EightLanes>(a: A, slices: Self::Slices<'_>, row: u32, base: u32) -> Self::Four<A>;
}

/// An entry of a [`ReadSet`].
pub trait Read: Copy + Send + Sync + 'static {
    /// The column.
    type Column: Column;
    /// Whether a term uses only differences of its values.
    const RELATIVE: bool;
}

impl<C: Column> Read for C {
    type Column = C;
    const RELATIVE: bool = false;
}

/// A column of which a term uses only differences between i and j. In single precision its values are less a
/// number that is the same for both: a difference then keeps the digits that it has in double precision.
#[derive(Clone, Copy)]
pub struct Relative<C>(PhantomData<C>);

impl<C: Column> Read for Relative<C> {
    type Column = C;
    const RELATIVE: bool = true;
}

/// Maximum number of components of a value.
const COMPONENTS: usize = 9;

#[inline(always)]
fn component<R: Read>(column: &[R::Column], row: u32, base: u32, k: usize) -> f64 {
    let value = column[row as usize].value().component(k);
    if R::RELATIVE { value - column[base as usize].value().component(k) } else { value }
}

#[inline(always)]
fn eight_of<R: Read, A: EightLanes>(
    a: A,
    column: &[R::Column],
    rows: &[u32; EIGHT],
    base: u32,
) -> <<R::Column as Column>::Value as Value>::Four<A> {
    let mut lanes = [Lanes8::ZERO; COMPONENTS];
    for k in 0..<R::Column as Column>::Value::COMPONENTS.len() {
        for lane in 0..EIGHT {
            lanes[k].0[lane] = component::<R>(column, rows[lane], base, k) as f32;
        }
    }
    <R::Column as Column>::Value::of_components(a, &lanes)
}

#[inline(always)]
fn same_of<R: Read, A: EightLanes>(
    a: A,
    column: &[R::Column],
    row: u32,
    base: u32,
) -> <<R::Column as Column>::Value as Value>::Four<A> {
    let mut lanes = [Lanes8::ZERO; COMPONENTS];
    for k in 0..<R::Column as Column>::Value::COMPONENTS.len() {
        lanes[k] = a.same(component::<R>(column, row, base, k) as f32);
    }
    <R::Column as Column>::Value::of_components(a, &lanes)
}

impl ReadSet for () {
    type Guards<'g> = ();
    type Slices<'s> = ();
    type Four<A: Arithmetic> = ();

    fn access() -> Vec<Access> {
        Vec::new()
    }

    fn guards<'g>(_: &PhaseView<'g>, _: Mode) -> Result<(), MissingColumn> {
        Ok(())
    }

    fn slices((): &(), _: Range<usize>) {}

    #[inline(always)]
    fn four<A: FourLanes>(_: A, (): (), _: [u32; 4], _: Option<&[DVec3; 4]>) {}

    #[inline(always)]
    fn eight<A: EightLanes>(_: A, (): (), _: &[u32; EIGHT], _: u32) {}

    #[inline(always)]
    fn same<A: EightLanes>(_: A, (): (), _: u32, _: u32) {}
}

#[inline(always)]
fn four_of<C: Column, A: FourLanes>(
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
        impl<$($name: Read),+> ReadSet for ($($name,)+) {
            type Guards<'g> = ($(hecs::ArchetypeColumn<'g, $name::Column>,)+);
            type Slices<'s> = ($(&'s [$name::Column],)+);
            type Four<A: Arithmetic> = ($(<<$name::Column as Column>::Value as Value>::Four<A>,)+);

            fn access() -> Vec<Access> {
                vec![$(Access { column: $name::Column::NAME, mode: Mode::Reads }),+]
            }

            fn guards<'g>(phase: &PhaseView<'g>, mode: Mode) -> Result<Self::Guards<'g>, MissingColumn> {
                Ok(($(phase.read_as::<$name::Column>(mode)?,)+))
            }

            fn slices<'s>(guards: &'s Self::Guards<'_>, rows: Range<usize>) -> Self::Slices<'s> {
                ($(&guards.$k[rows.clone()],)+)
            }

            #[inline(always)]
            fn four<A: FourLanes>(
                a: A,
                slices: Self::Slices<'_>,
                rows: [u32; 4],
                signs: Option<&[DVec3; 4]>,
            ) -> Self::Four<A> {
                ($(four_of(a, slices.$k, rows, signs),)+)
            }

            #[inline(always)]
            fn eight<A: EightLanes>(
                a: A,
                slices: Self::Slices<'_>,
                rows: &[u32; EIGHT],
                base: u32,
            ) -> Self::Four<A> {
                ($(eight_of::<$name, A>(a, slices.$k, rows, base),)+)
            }

            #[inline(always)]
            fn same<A: EightLanes>(a: A, slices: Self::Slices<'_>, row: u32, base: u32) -> Self::Four<A> {
                ($(same_of::<$name, A>(a, slices.$k, row, base),)+)
            }
        }
    };
}
read_set!(P 0);
read_set!(P 0, Q 1);
read_set!(P 0, Q 1, R 2);
read_set!(P 0, Q 1, R 2, S 3);
read_set!(P 0, Q 1, R 2, S 3, T 4);
