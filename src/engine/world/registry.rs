//! The table of column types: operations of the engine on a column of unknown type.

use std::any::TypeId;
use std::collections::BTreeMap;
use std::ops::Range;

use hecs::{Archetype, ColumnBatchBuilder, ColumnBatchType};

use super::column::{Column, Value};

/// A column type, with its type erased: used by spawning, checkpoints, recordings and hashes.
#[derive(Clone, Copy, Debug)]
pub struct ColumnInfo {
    /// Name used in scenes and errors.
    pub name: &'static str,
    /// Symbol used in formulas.
    pub symbol: &'static str,
    /// Unit, SI.
    pub unit: &'static str,
    /// Description.
    pub about: &'static str,
    /// Names of the components of a row.
    pub components: &'static [&'static str],
    /// Bytes per row.
    pub element_size: usize,
    /// The Rust type.
    pub type_id: TypeId,
    declare: fn(&mut ColumnBatchType),
    zero: fn(&mut ColumnBatchBuilder),
    read: fn(&Archetype, &mut dyn FnMut(&[u8])),
    write: fn(&Archetype, &mut dyn FnMut(&mut [u8])),
    component: fn(&Archetype, Range<usize>, usize, &mut Vec<f64>),
}

impl ColumnInfo {
    /// The entry of column type `T`.
    pub fn of<T: Column>() -> Self {
        Self {
            name: T::NAME,
            symbol: T::SYMBOL,
            unit: T::UNIT,
            about: T::ABOUT,
            components: T::Value::COMPONENTS,
            element_size: size_of::<T>(),
            type_id: TypeId::of::<T>(),
            declare: |batch| {
                batch.add::<T>();
            },
            zero: |batch| {
                if let Some(mut writer) = batch.writer::<T>() {
                    while writer.push(T::zeroed()).is_ok() {}
                }
            },
            read: |archetype, f| {
                if let Some(column) = archetype.get::<&T>() {
                    f(bytemuck::cast_slice(&column));
                }
            },
            write: |archetype, f| {
                if let Some(mut column) = archetype.get::<&mut T>() {
                    f(bytemuck::cast_slice_mut(&mut column));
                }
            },
            component: |archetype, rows, k, out| {
                if let Some(column) = archetype.get::<&T>() {
                    out.extend(column[rows].iter().map(|row| row.value().component(k)));
                }
            },
        }
    }

    pub(super) fn declare(&self, batch: &mut ColumnBatchType) {
        (self.declare)(batch);
    }

    pub(super) fn zero(&self, batch: &mut ColumnBatchBuilder) {
        (self.zero)(batch);
    }

    /// Calls `f` with the bytes of the column, if the archetype has it.
    pub(super) fn read(&self, archetype: &Archetype, f: &mut dyn FnMut(&[u8])) {
        (self.read)(archetype, f);
    }

    /// Calls `f` with the writable bytes of the column, if the archetype has it.
    pub(super) fn write(&self, archetype: &Archetype, f: &mut dyn FnMut(&mut [u8])) {
        (self.write)(archetype, f);
    }

    /// Appends component `k` of the given rows to `out`, if the archetype has the column.
    pub(super) fn component(&self, archetype: &Archetype, rows: Range<usize>, k: usize, out: &mut Vec<f64>) {
        (self.component)(archetype, rows, k, out);
    }
}

/// The columns of a phase, each once, in the order of their names.
#[derive(Clone, Debug, Default)]
pub struct ColumnSet(BTreeMap<&'static str, ColumnInfo>);

impl ColumnSet {
    /// Adds column `T`; adding it again changes nothing.
    pub fn add<T: Column>(&mut self) -> &mut Self {
        self.0.insert(T::NAME, ColumnInfo::of::<T>());
        self
    }

    /// Adds every column of another set.
    pub fn extend(&mut self, other: &ColumnSet) {
        self.0.extend(other.0.iter());
    }

    /// The columns in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = &ColumnInfo> {
        self.0.values()
    }

    /// The column of that name.
    pub fn get(&self, name: &str) -> Option<&ColumnInfo> {
        self.0.get(name)
    }

    /// Bytes per particle.
    pub fn bytes_per_row(&self) -> usize {
        self.0.values().map(|column| column.element_size).sum()
    }
}
