//! The particles: one hecs archetype per phase, in a hecs world of its own, bodies as row ranges in it.

use std::ops::Range;
use std::sync::Arc;

use hecs::{Archetype, ArchetypeColumn, ArchetypeColumnMut, ColumnBatchType};
use thiserror::Error;

use super::access::{Declared, Mode, Undeclared, Watch};
use super::body::{Body, BodyId, PhaseId};
use super::column::Column;
use super::own_only::OwnOnly;
use super::registry::{ColumnInfo, ColumnSet};
use crate::scene::Dimension;

/// The particles of one formulation.
pub struct Phase {
    /// Name of the formulation.
    pub name: &'static str,
    /// Its columns.
    pub columns: ColumnSet,
    /// Number of particles.
    pub len: usize,
    archetype: usize,
    ecs: hecs::World,
    /// Rows of its bodies, in scene order.
    bodies: Vec<Range<usize>>,
    own_only: OwnOnly,
}

/// A column was asked for that the phase does not have.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("the phase `{phase}` has no column `{column}`; a plugin adds it with `SimBuilder::add_column`")]
pub struct MissingColumn {
    /// Name of the column.
    pub column: &'static str,
    /// Name of the phase.
    pub phase: &'static str,
}

/// All particles of a simulation; the columns are the only particle state.
pub struct World {
    phases: Vec<Phase>,
    bodies: Vec<Body>,
    dimension: Dimension,
    watch: Arc<Watch>,
}

impl World {
    /// A world without particles.
    pub fn new(dimension: Dimension) -> Self {
        Self { phases: Vec::new(), bodies: Vec::new(), dimension, watch: Arc::new(Watch::new(Vec::new())) }
    }

    /// Two: plane strain in x-y; three.
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// Spawns the `len` particles of a phase with all columns zero.
    pub fn spawn_phase(&mut self, name: &'static str, columns: ColumnSet, len: usize) -> PhaseId {
        let mut batch = ColumnBatchType::new();
        columns.iter().for_each(|column| column.declare(&mut batch));
        let mut builder = batch.into_batch(u32::try_from(len).unwrap_or(u32::MAX));
        columns.iter().for_each(|column| column.zero(&mut builder));
        // One world a phase: two formulations with the same columns would share an archetype.
        let mut ecs = hecs::World::new();
        let before = ecs.archetypes().len();
        if let Ok(batch) = builder.build() {
            ecs.spawn_column_batch(batch);
        }
        let archetype = if ecs.archetypes().len() > before { before } else { before - 1 };
        let own_only = OwnOnly::of(&columns);
        self.phases.push(Phase { name, columns, len, archetype, ecs, bodies: Vec::new(), own_only });
        PhaseId(self.phases.len() - 1)
    }

    /// Adds a body; its rows must lie in its phase.
    pub fn add_body(&mut self, body: Body) -> BodyId {
        self.phases[body.phase.0].bodies.push(body.rows.clone());
        self.bodies.push(body);
        BodyId(self.bodies.len() - 1)
    }

    /// The bodies in scene order.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// The body with that id.
    pub fn body(&self, id: BodyId) -> &Body {
        &self.bodies[id.0]
    }

    /// The bodies of a phase with their ids, in scene order.
    pub fn bodies_of(&self, phase: PhaseId) -> impl Iterator<Item = (BodyId, &Body)> {
        self.bodies
            .iter()
            .enumerate()
            .filter(move |(_, body)| body.phase == phase)
            .map(|(k, b)| (BodyId(k), b))
    }

    /// Ids of all phases.
    pub fn phases(&self) -> impl Iterator<Item = PhaseId> + use<> {
        (0..self.phases.len()).map(PhaseId)
    }

    /// The phase of the formulation of that name.
    pub fn phase_named(&self, name: &str) -> Option<PhaseId> {
        self.phases.iter().position(|phase| phase.name == name).map(PhaseId)
    }

    /// A view of the columns of a phase.
    pub fn phase(&self, id: PhaseId) -> PhaseView<'_> {
        let phase = &self.phases[id.0];
        let archetype = phase.ecs.archetypes().nth(phase.archetype).expect("archetypes are never removed");
        PhaseView { phase, archetype, watch: &self.watch }
    }

    /// From now on the accesses of systems are checked against their declarations, in the order of the
    /// schedule.
    pub(crate) fn declare(&mut self, systems: Vec<Declared>) {
        self.watch = Arc::new(Watch::new(systems));
    }

    /// The record of accesses of systems, also for shared data.
    pub(crate) fn watch(&self) -> Arc<Watch> {
        Arc::clone(&self.watch)
    }

    /// The system that runs from now on, if one does.
    pub(crate) fn enter(&self, system: Option<usize>) {
        self.watch.enter(system);
    }

    /// The first access that a system has not declared.
    pub(crate) fn undeclared(&self) -> Option<&Undeclared> {
        self.watch.first()
    }

    /// The columns of a body's phase and the body's rows.
    pub fn body_view(&self, id: BodyId) -> (PhaseView<'_>, Range<usize>) {
        let body = self.body(id);
        (self.phase(body.phase), body.rows.clone())
    }

    /// Number of particles of all phases.
    pub fn len(&self) -> usize {
        self.phases.iter().map(|phase| phase.len).sum()
    }

    /// Whether there is no particle.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes held by the columns of all phases.
    pub fn bytes(&self) -> usize {
        self.phases.iter().map(|phase| phase.len * phase.columns.bytes_per_row()).sum()
    }
}

/// The columns of one phase; every column is borrowed on its own, as a slice.
#[derive(Clone, Copy)]
pub struct PhaseView<'a> {
    phase: &'a Phase,
    archetype: &'a Archetype,
    watch: &'a Watch,
}

impl<'a> PhaseView<'a> {
    /// Name of the formulation.
    pub fn name(&self) -> &'static str {
        self.phase.name
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.phase.len
    }

    /// Whether the phase has no particle.
    pub fn is_empty(&self) -> bool {
        self.phase.len == 0
    }

    /// Its columns.
    pub fn columns(&self) -> &'a ColumnSet {
        &self.phase.columns
    }

    /// Whether it has column `T`.
    pub fn has<T: Column>(&self) -> bool {
        self.archetype.has::<T>()
    }

    /// Column `T` for reading the system's own rows. An error if the phase lacks the column. Panics if a
    /// system holds it for writing: the schedule excludes that.
    pub fn read<T: Column>(&self) -> Result<ArchetypeColumn<'a, T>, MissingColumn> {
        self.read_as(Mode::Reads)
    }

    /// Column `T` for reading rows of neighbours too, which the system declares by `System::reads_near`. An
    /// error if the phase lacks the column.
    pub fn read_near<T: Column>(&self) -> Result<ArchetypeColumn<'a, T>, MissingColumn> {
        self.read_as(Mode::ReadsNear)
    }

    pub(crate) fn read_as<T: Column>(&self, mode: Mode) -> Result<ArchetypeColumn<'a, T>, MissingColumn> {
        self.complete(&ColumnInfo::of::<T>());
        self.column(mode)
    }

    pub(super) fn column<T: Column>(&self, mode: Mode) -> Result<ArchetypeColumn<'a, T>, MissingColumn> {
        let column = self.archetype.get::<&T>().ok_or(self.missing::<T>())?;
        self.watch.touches::<T>(mode);
        Ok(column)
    }

    /// Column `T` for writing. Panics if a system holds it already: the schedule excludes that.
    pub fn write<T: Column>(&self) -> Result<ArchetypeColumnMut<'a, T>, MissingColumn> {
        self.complete(&ColumnInfo::of::<T>());
        self.column_mut()
    }

    pub(super) fn column_mut<T: Column>(&self) -> Result<ArchetypeColumnMut<'a, T>, MissingColumn> {
        let column = self.archetype.get::<&mut T>().ok_or(self.missing::<T>())?;
        self.watch.touches::<T>(Mode::Writes);
        Ok(column)
    }

    fn missing<T: Column>(&self) -> MissingColumn {
        MissingColumn { column: T::NAME, phase: self.phase.name }
    }

    /// Calls `f` with the bytes of a column.
    pub fn read_bytes(&self, column: &ColumnInfo, f: &mut dyn FnMut(&[u8])) {
        self.complete(column);
        column.read(self.archetype, f);
    }

    /// Calls `f` with the writable bytes of a column.
    pub fn write_bytes(&self, column: &ColumnInfo, f: &mut dyn FnMut(&mut [u8])) {
        self.complete(column);
        self.write_own_bytes(column, f);
    }

    /// Calls `f` with the writable bytes of a column, of which it writes rows of this rank.
    pub(super) fn write_own_bytes(&self, column: &ColumnInfo, f: &mut dyn FnMut(&mut [u8])) {
        column.write(self.archetype, f);
    }

    /// Rows of the bodies of the phase, in scene order.
    pub(crate) fn body_rows(&self) -> &'a [Range<usize>] {
        &self.phase.bodies
    }

    pub(super) fn own_only(&self) -> &'a OwnOnly {
        &self.phase.own_only
    }

    /// Calls `f` with the writable bytes of several columns, at most `N`, in their order; slices that no
    /// column takes are empty. Nothing is called where the phase lacks one of them.
    pub fn write_bytes_of<const N: usize>(&self, columns: &[ColumnInfo], f: &mut dyn FnMut([&mut [u8]; N])) {
        columns.iter().for_each(|column| self.complete(column));
        self.borrow_next(columns, 0, std::array::from_fn(|_| Default::default()), f);
    }

    /// [`PhaseView::write_bytes_of`] for a loop that is divided among ranks.
    pub(crate) fn write_own_bytes_of<const N: usize>(
        &self,
        columns: &[ColumnInfo],
        f: &mut dyn FnMut([&mut [u8]; N]),
    ) {
        columns.iter().for_each(|column| self.mark_own(column.type_id));
        self.borrow_next(columns, 0, std::array::from_fn(|_| Default::default()), f);
    }

    fn borrow_next<const N: usize>(
        &self,
        columns: &[ColumnInfo],
        k: usize,
        held: [&mut [u8]; N],
        f: &mut dyn FnMut([&mut [u8]; N]),
    ) {
        let Some(column) = columns.get(k) else { return f(held) };
        let mut held = Some(held);
        self.write_own_bytes(column, &mut |bytes| {
            if let Some(mut held) = held.take() {
                held[k] = bytes;
                self.borrow_next(columns, k + 1, held, f);
            }
        });
    }

    /// Appends component `k` of the rows of a column to `out`.
    pub fn component(&self, column: &ColumnInfo, rows: Range<usize>, k: usize, out: &mut Vec<f64>) {
        self.complete(column);
        column.component(self.archetype, rows, k, out);
    }
}
