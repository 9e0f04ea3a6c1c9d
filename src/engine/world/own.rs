//! Columns of which a rank has computed its own rows only: they are exchanged when a system reads the rest.
//!
//! A pass that is divided among ranks writes a column by [`PhaseView::write_own`]. The rows of other ranks
//! are old from then on, until the column is read or written as a whole; that exchanges it. The calls of a
//! step follow from equal values, so that all ranks come to the same exchange.

use std::any::TypeId;
use std::sync::atomic::Ordering;

use hecs::{ArchetypeColumn, ArchetypeColumnMut};

use super::access::Mode;
use super::column::Column;
use super::registry::ColumnInfo;
use super::state::{MissingColumn, PhaseView};
use crate::parallel::BLOCK;
use crate::ranks::{self, Halo};

impl<'a> PhaseView<'a> {
    /// Column `T` for reading rows of this rank ([`own_rows`](crate::parallel::own_rows)), in a loop that is
    /// divided among ranks. Rows of other ranks may be old. An error if the phase lacks the column.
    pub fn read_own<T: Column>(&self) -> Result<ArchetypeColumn<'a, T>, MissingColumn> {
        self.column(Mode::Reads)
    }

    /// Column `T` for writing rows of this rank, in a loop that is divided among ranks. The next read of the
    /// column exchanges the rows of all ranks. An error if the phase lacks the column.
    pub fn write_own<T: Column>(&self) -> Result<ArchetypeColumnMut<'a, T>, MissingColumn> {
        self.mark_own(TypeId::of::<T>());
        self.column_mut()
    }

    /// Column `T` for writing rows of this rank by a loop that finds out whether it changes any: if so,
    /// [`PhaseView::mark_own`] comes after it.
    pub(crate) fn write_unmarked<T: Column>(&self) -> Result<ArchetypeColumnMut<'a, T>, MissingColumn> {
        self.column_mut()
    }

    /// Column `T` for reading rows of this rank and those of its halo, which are exchanged if every rank has
    /// its own only. Other rows may be old. An error if the phase lacks the column.
    pub fn read_halo<T: Column>(&self, halo: &Halo) -> Result<ArchetypeColumn<'a, T>, MissingColumn> {
        let column = ColumnInfo::of::<T>();
        let flag = self.own_only().flag(self.columns(), column.type_id);
        if flag.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            self.write_own_bytes(&column, &mut |bytes| halo.fill_bytes(bytes, column.element_size));
        }
        self.column(Mode::ReadsNear)
    }

    /// The rows of a column are written by each rank for its own from now on.
    pub(crate) fn mark_own(&self, column: TypeId) {
        if ranks::has_several()
            && let Some((column, flag)) = self.own_only().of_column(self.columns(), column)
        {
            flag.store(true, Ordering::Relaxed);
            self.own_only().any.store(true, Ordering::Relaxed);
            let bodies = self.body_rows().iter().cloned();
            self.write_own_bytes(column, &mut |bytes| {
                ranks::spoil_others(bytes, column.element_size, BLOCK, bodies.clone());
            });
        }
    }

    /// Exchanges the rows of a column if every rank has its own alone.
    pub(super) fn complete(&self, column: &ColumnInfo) {
        let flag = self.own_only().flag(self.columns(), column.type_id);
        if flag.is_some_and(|flag| flag.swap(false, Ordering::Relaxed)) {
            self.exchange(column);
        }
    }

    #[cold]
    fn exchange(&self, column: &ColumnInfo) {
        assert!(ranks::has_several(), "`{}` is read as a whole inside of a loop of ranks", column.name);
        let bodies = self.body_rows().iter().cloned();
        self.write_own_bytes(column, &mut |bytes| {
            ranks::share_bodies(bytes, column.element_size, BLOCK, bodies.clone());
        });
    }

    /// Exchanges all columns of which every rank has only its own rows: before the rows are divided anew.
    pub fn complete_all(&self) {
        self.columns().iter().for_each(|column| self.complete(column));
    }
}
