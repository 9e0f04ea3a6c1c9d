//! Rows of several columns for reading, with a value as the result.

use std::ops::Range;

use crate::parallel::{Split, for_each_block};
use crate::world::{Column, MissingColumn, PhaseView, Value};

/// Columns that a field is a function of: a tuple of up to four column types.
pub trait FieldColumns: 'static {
    /// One row of the columns.
    type Row<'r>;

    /// Names of the columns.
    fn names() -> Vec<&'static str>;

    /// Appends the components of `f` of every row to `out`, in row order.
    ///
    /// # Errors
    /// The phase has not all of the columns.
    fn evaluate<V: Value>(
        phase: &PhaseView<'_>,
        rows: Range<usize>,
        f: &(impl for<'r> Fn(Self::Row<'r>) -> V + Sync),
        out: &mut Vec<f64>,
    ) -> Result<(), MissingColumn>;
}

/// The components of a block of rows.
struct BlockComponents<'a> {
    values: &'a mut [f64],
    width: usize,
}

impl Split for BlockComponents<'_> {
    fn rows(&self) -> usize {
        self.values.len() / self.width
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (left, right) = self.values.split_at_mut(at * self.width);
        (Self { values: left, width: self.width }, Self { values: right, width: self.width })
    }
}

macro_rules! field_columns {
    ($($name:ident $k:tt),+) => {
        impl<$($name: Column),+> FieldColumns for ($($name,)+) {
            type Row<'r> = ($(&'r $name,)+);

            fn names() -> Vec<&'static str> {
                vec![$($name::NAME),+]
            }

            fn evaluate<V: Value>(
                phase: &PhaseView<'_>,
                rows: Range<usize>,
                f: &(impl for<'r> Fn(Self::Row<'r>) -> V + Sync),
                out: &mut Vec<f64>,
            ) -> Result<(), MissingColumn> {
                let guards = ($(phase.read::<$name>()?,)+);
                let (start, width) = (out.len(), V::COMPONENTS.len());
                out.resize(start + rows.len() * width, 0.0);
                let values = BlockComponents { values: &mut out[start..], width };
                let slices = (values, $(&guards.$k[rows.clone()],)+);
                type Block<'a, $($name),+> = (BlockComponents<'a>, $(&'a [$name],)+);
                for_each_block(slices, &mut Vec::new(), &|_, block: Block<'_, $($name),+>| {
                    let (out, columns) = field_columns!(@split block, $($k),+);
                    for (k, values) in out.values.chunks_exact_mut(width).enumerate() {
                        let value = f(($(&columns.$k[k],)+));
                        for (c, component) in values.iter_mut().enumerate() {
                            *component = value.component(c);
                        }
                    }
                });
                Ok(())
            }
        }
    };
    (@split $block:ident, 0) => { ($block.0, ($block.1,)) };
    (@split $block:ident, 0, 1) => { ($block.0, ($block.1, $block.2)) };
    (@split $block:ident, 0, 1, 2) => { ($block.0, ($block.1, $block.2, $block.3)) };
    (@split $block:ident, 0, 1, 2, 3) => { ($block.0, ($block.1, $block.2, $block.3, $block.4)) };
}
field_columns!(A 0);
field_columns!(A 0, B 1);
field_columns!(A 0, B 1, C 2);
field_columns!(A 0, B 1, C 2, D 3);
