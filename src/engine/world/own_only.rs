//! The columns of a phase that are valid only in the rows of this rank.

use std::any::TypeId;
use std::sync::atomic::{AtomicBool, Ordering};

use super::registry::{ColumnInfo, ColumnSet};

/// Which columns of a phase are there for the rows of this rank alone, in the order of the columns.
#[derive(Debug, Default)]
pub(super) struct OwnOnly {
    flags: Vec<AtomicBool>,
    /// Whether any has ever been: on one rank none is, and every access asks.
    pub any: AtomicBool,
}

impl OwnOnly {
    pub fn of(columns: &ColumnSet) -> Self {
        Self { flags: columns.iter().map(|_| AtomicBool::new(false)).collect(), any: AtomicBool::new(false) }
    }

    /// The column and its flag.
    pub fn of_column<'s>(
        &'s self,
        columns: &'s ColumnSet,
        column: TypeId,
    ) -> Option<(&'s ColumnInfo, &'s AtomicBool)> {
        columns.iter().zip(&self.flags).find(|(own, _)| own.type_id == column)
    }

    /// The flag of a column, if there is one and any is set.
    pub fn flag<'s>(&'s self, columns: &'s ColumnSet, column: TypeId) -> Option<&'s AtomicBool> {
        let any = self.any.load(Ordering::Relaxed);
        any.then(|| self.of_column(columns, column))?.map(|(_, flag)| flag)
    }
}
