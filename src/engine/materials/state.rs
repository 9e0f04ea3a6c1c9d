//! The state of a material: columns that a law declares, passed to it block by block.

use std::any::TypeId;

use crate::parallel::Split;
use crate::world::{Column, ColumnInfo, ColumnSet};

/// Maximum number of state columns that one law may have.
pub const MAX_STATE: usize = 24;

/// The state columns of a law, in the order of their names.
#[derive(Clone, Debug, Default)]
pub struct StateColumns(Vec<ColumnInfo>);

impl StateColumns {
    /// The columns of a set; `None` where they are more than [`MAX_STATE`].
    pub fn new(columns: &ColumnSet) -> Option<Self> {
        let columns: Vec<ColumnInfo> = columns.iter().copied().collect();
        (columns.len() <= MAX_STATE).then_some(Self(columns))
    }

    /// The columns.
    pub fn as_slice(&self) -> &[ColumnInfo] {
        &self.0
    }
}

/// The state of some particles of one material: a slice of each column that the law has declared, all of one
/// length. The default has no column.
#[derive(Default)]
pub struct StateRows<'a> {
    columns: &'a [ColumnInfo],
    bytes: [&'a mut [u8]; MAX_STATE],
}

impl<'a> StateRows<'a> {
    /// The rows of columns given as bytes, one slice for each column in its order.
    pub fn new(columns: &'a StateColumns, bytes: [&'a mut [u8]; MAX_STATE]) -> Self {
        Self { columns: &columns.0, bytes }
    }

    /// The same rows for a shorter time: what a law hands to the law that it wraps.
    pub fn reborrow(&mut self) -> StateRows<'_> {
        let mut bytes: [&mut [u8]; MAX_STATE] = Default::default();
        for (copy, slice) in bytes.iter_mut().zip(&mut self.bytes) {
            *copy = slice;
        }
        StateRows { columns: self.columns, bytes }
    }

    /// Takes the slice of column `T` out of the rows, so that several can be held at once. Panics where the
    /// law has not declared the column, or has taken it already: a fault of the law.
    pub fn take<T: Column>(&mut self) -> &'a mut [T] {
        let place = self.columns.iter().position(|column| column.type_id == TypeId::of::<T>());
        let Some(k) = place else { panic!("the law has not declared the state column `{}`", T::NAME) };
        let bytes = std::mem::take(&mut self.bytes[k]);
        bytemuck::cast_slice_mut(bytes)
    }
}

impl Split for StateRows<'_> {
    fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| self.bytes[0].len() / column.element_size)
    }

    fn split(self, at: usize) -> (Self, Self) {
        let mut before = Self { columns: self.columns, bytes: Default::default() };
        let mut after = Self { columns: self.columns, bytes: Default::default() };
        for ((k, column), bytes) in self.columns.iter().enumerate().zip(self.bytes) {
            (before.bytes[k], after.bytes[k]) = bytes.split_at_mut(at * column.element_size);
        }
        (before, after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{PlasticStrain, Temperature};

    fn columns() -> StateColumns {
        let mut set = ColumnSet::default();
        set.add::<PlasticStrain>().add::<Temperature>();
        StateColumns::new(&set).expect("two columns")
    }

    #[test]
    fn rows_are_cut_column_by_column() {
        let columns = columns();
        let mut strain: Vec<PlasticStrain> = (0..5).map(|k| PlasticStrain(f64::from(k))).collect();
        let mut temperature = vec![Temperature(300.0); 5];
        let mut bytes: [&mut [u8]; MAX_STATE] = Default::default();
        bytes[0] = bytemuck::cast_slice_mut(&mut strain);
        bytes[1] = bytemuck::cast_slice_mut(&mut temperature);
        let rows = StateRows::new(&columns, bytes);
        assert_eq!(rows.rows(), 5);
        let (mut before, mut after) = rows.split(2);
        assert_eq!(before.reborrow().take::<PlasticStrain>(), [PlasticStrain(0.0), PlasticStrain(1.0)]);
        let (strain, temperature) = (after.take::<PlasticStrain>(), after.take::<Temperature>());
        assert_eq!((strain.len(), temperature.len()), (3, 3));
        strain[0].0 = 9.0;
        assert_eq!(before.take::<PlasticStrain>().len(), 2);
        assert_eq!(strain, [PlasticStrain(9.0), PlasticStrain(3.0), PlasticStrain(4.0)]);
    }

    #[test]
    fn no_state_has_no_rows() {
        let (before, after) = StateRows::default().split(64);
        assert_eq!((before.rows(), after.rows()), (0, 0));
    }

    #[test]
    #[should_panic(expected = "has not declared the state column `temperature`")]
    fn a_column_that_was_not_declared_is_a_fault() {
        StateRows::default().take::<Temperature>();
    }
}
