//! A system: a part of the step with a stage, a label, declared access to columns, and a position in the
//! order.

use super::each::EachRow;
use super::ledger::{AccountKind, EnergyAccount};
use super::resources::Resources;
use super::stage::Stage;
use super::step::{Step, StepError};
use super::step_part::Cadence;
use crate::scene::Item;
use crate::world::{Access, BodySet, Column, Declared, Mode, PhaseId};

/// The work of a system. A closure is enough for a system without state of its own.
pub trait Run: Send {
    /// Does the system's work in this step. An error ends the run.
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError>;

    /// State that must survive a restart and is in no column.
    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    /// Restores the state that [`Run::save`] returned. Returns `false` if the bytes are not of that form.
    fn restore(&mut self, state: &[u8]) -> bool {
        state.is_empty()
    }

    /// [`Run::save`] for a system whose state is in shared data.
    fn save_with(&self, _: &Resources) -> Vec<u8> {
        self.save()
    }

    /// Restores the state that [`Run::save_with`] returned.
    fn restore_with(&mut self, state: &[u8], _: &Resources) -> bool {
        self.restore(state)
    }
}

impl<F: FnMut(&mut Step<'_>) -> Result<(), StepError> + Send> Run for F {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        self(step)
    }
}

/// A system of the schedule.
pub struct System {
    pub(super) label: String,
    pub(super) stage: Stage,
    pub(super) access: Vec<Access>,
    /// Access to rows that are packed from several phases.
    pub(super) packed: Vec<Access>,
    reads_all: bool,
    /// Whether packed rows near those of this rank are enough for it.
    is_local: bool,
    pub(super) phases: Option<Vec<PhaseId>>,
    bodies: Option<BodySet>,
    long: bool,
    by_body: bool,
    pub(super) before: Vec<String>,
    pub(super) after: Vec<String>,
    pub(super) after_any: Vec<String>,
    pub(super) work: Box<dyn Run>,
    /// Item of the scene that has added it, for errors.
    pub(super) item: Option<Item>,
}

impl System {
    /// A system that sees the whole step. Declare the columns it touches with [`System::reads`] and its
    /// siblings.
    pub fn new(stage: Stage, label: impl Into<String>, work: impl Run + 'static) -> Self {
        Self {
            label: label.into(),
            stage,
            access: Vec::new(),
            packed: Vec::new(),
            reads_all: false,
            is_local: false,
            phases: None,
            bodies: None,
            long: false,
            by_body: false,
            before: Vec::new(),
            after: Vec::new(),
            after_any: Vec::new(),
            work: Box::new(work),
            item: None,
        }
    }

    /// A system that calls `f` for every particle of the bodies, in parallel, with the columns named by `Q`:
    /// a tuple of `&Column`, `&mut Column` and `Adds<Column>`. The access is declared by the types.
    pub fn each<Q: EachRow>(
        stage: Stage,
        label: impl Into<String>,
        bodies: BodySet,
        f: impl for<'r> Fn(&super::step::Clock, Q::Row<'r>) + Send + Sync + 'static,
    ) -> Self {
        let of = bodies.clone();
        let mut system = Self::new(stage, label, move |step: &mut Step<'_>| {
            let clock = step.clock;
            for body in step.part.due(step.world, &bodies) {
                let (phase, rows) = step.world.body_view(body);
                Q::for_each(&phase, rows, &|row| f(&clock, row))?;
            }
            Ok(())
        });
        Q::declare(&mut system.access);
        system.bodies = Some(of);
        system.by_body()
    }

    /// [`System::each`] for a system whose energy has an account: `f` also returns the energy of the
    /// particle, J. For an account that is [`AccountKind::Stored`] it is the current energy of the particle,
    /// for other kinds the energy supplied or dissipated in this step.
    pub fn each_with_energy<Q: EachRow>(
        stage: Stage,
        label: impl Into<String>,
        bodies: BodySet,
        account: EnergyAccount,
        f: impl for<'r> Fn(&super::step::Clock, Q::Row<'r>) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let of = bodies.clone();
        let mut system = Self::new(stage, label, move |step: &mut Step<'_>| {
            let clock = step.clock;
            let EnergyAccount { name, kind } = account;
            let account = step.ledger.account(name, kind);
            for body in step.part.due(step.world, &bodies) {
                let (phase, rows) = step.world.body_view(body);
                let energy = Q::for_each(&phase, rows, &|row| f(&clock, row))?;
                match kind {
                    AccountKind::Stored => step.ledger.set(account, body, energy),
                    AccountKind::Supplied | AccountKind::Dissipated => {
                        step.ledger.add(account, body, energy);
                    }
                }
            }
            Ok(())
        });
        Q::declare(&mut system.access);
        system.bodies = Some(of);
        system.by_body()
    }

    /// Names the item of the scene that has added it.
    pub(crate) fn added_by(mut self, item: Option<Item>) -> Self {
        self.item = item;
        self
    }

    /// Declares that the system reads column `T`.
    pub fn reads<T: Column>(self) -> Self {
        self.touches(T::NAME, Mode::Reads)
    }

    /// Declares that the system reads column `T` in rows of neighbours: on several machines or beside a GPU
    /// these are to be exchanged first.
    pub fn reads_near<T: Column>(self) -> Self {
        self.touches(T::NAME, Mode::ReadsNear)
    }

    /// Declares that the system writes column `T`.
    pub fn writes<T: Column>(self) -> Self {
        self.touches(T::NAME, Mode::Writes)
    }

    /// Declares that the system adds to column `T`.
    pub fn adds<T: Column>(self) -> Self {
        self.touches(T::NAME, Mode::Adds)
    }

    /// Declares access to the column of that name, or to shared data.
    pub fn touches(mut self, column: &'static str, mode: Mode) -> Self {
        self.access.push(Access { column, mode });
        self
    }

    /// Declares that the system may read every column, in any row, as outputs do. Its stage must have no
    /// writers, or its order after them must be stated.
    pub fn reads_all(mut self) -> Self {
        self.reads_all = true;
        self
    }

    /// Declares access to shared data other than columns of one phase
    /// ([`Shareable::ROWS`](super::Shareable::ROWS)), by the name of its rows: systems that touch them share
    /// rows whatever their phases are.
    pub fn touches_packed(mut self, rows: &'static str, mode: Mode) -> Self {
        self.packed.push(Access { column: rows, mode });
        self
    }

    /// Declares that it reads only the packed rows of this rank and those near them, or requests the rest
    /// itself: no others are exchanged for it.
    pub fn reads_own_packed(mut self) -> Self {
        self.is_local = true;
        self
    }

    /// Whether packed rows of all ranks must be there when it runs.
    pub(super) fn needs_all_packed(&self) -> bool {
        let reads = |access: &Access| matches!(access.mode, Mode::Reads | Mode::ReadsNear);
        !self.is_local && self.packed.iter().any(reads)
    }

    /// Declares access to several.
    pub fn touches_all(mut self, access: impl IntoIterator<Item = Access>) -> Self {
        self.access.extend(access);
        self
    }

    /// Declares that only these phases are touched: systems of different phases never conflict.
    pub fn on_phases(mut self, phases: impl IntoIterator<Item = PhaseId>) -> Self {
        self.phases = Some(phases.into_iter().collect());
        self
    }

    /// Declares that only rows of these bodies are touched, in every column: systems of different bodies
    /// never conflict. A plugin that several bodies have, each for itself, adds a system for each of them.
    pub fn on_bodies(mut self, bodies: BodySet) -> Self {
        self.bodies = Some(bodies);
        self
    }

    /// Declares that the system acts only on the bodies that are due
    /// ([`StepPart::due`](super::StepPart::due)): where some of its phases are sub-cycled and others are not,
    /// it runs in the long step and in the short ones.
    pub fn by_body(mut self) -> Self {
        self.by_body = true;
        self
    }

    /// Declares that the system runs once per step, also where all phases that it touches are sub-cycled.
    pub fn in_long_steps(mut self) -> Self {
        self.long = true;
        self
    }

    /// Runs before every system of its stage with that label.
    pub fn before(mut self, label: impl Into<String>) -> Self {
        self.before.push(label.into());
        self
    }

    /// Runs after every system of its stage with that label.
    pub fn after(mut self, label: impl Into<String>) -> Self {
        self.after.push(label.into());
        self
    }

    /// Runs after every system of its stage with that label, if there are any: a plugin need not be in the
    /// scene.
    pub fn after_any(mut self, label: impl Into<String>) -> Self {
        self.after_any.push(label.into());
        self
    }

    /// Label.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Stage.
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// Declared access.
    pub fn access(&self) -> &[Access] {
        &self.access
    }

    /// Declared access to columns and shared data.
    pub(super) fn declared(&self) -> Declared {
        let access = (!self.reads_all).then(|| self.access.iter().chain(&self.packed).copied().collect());
        Declared { system: self.label.clone(), access }
    }

    /// The bodies whose rows alone are touched, if the system does not say which phases it touches.
    pub(crate) fn bodies_without_phases(&self) -> Option<&BodySet> {
        self.bodies.as_ref().filter(|_| self.phases.is_none())
    }

    /// When it runs, where these phases are sub-cycled.
    pub(super) fn cadence(&self, sub_cycled: &[PhaseId]) -> Cadence {
        let Some(phases) = self.phases.as_ref().filter(|phases| !self.long && !phases.is_empty()) else {
            return Cadence::Long;
        };
        let short = phases.iter().filter(|phase| sub_cycled.contains(phase)).count();
        if short == phases.len() {
            Cadence::Short
        } else if short > 0 && self.by_body {
            Cadence::Both
        } else {
            Cadence::Long
        }
    }

    /// Whether the two may touch the same rows.
    pub(super) fn shares_rows_with(&self, other: &System) -> bool {
        let phases = match (&self.phases, &other.phases) {
            (Some(a), Some(b)) => a.iter().any(|phase| b.contains(phase)),
            _ => true,
        };
        let bodies = match (&self.bodies, &other.bodies) {
            (Some(a), Some(b)) => a.iter().any(|body| b.contains(body)),
            _ => true,
        };
        phases && bodies
    }

    fn has(&self, column: &str, mode: Mode) -> bool {
        self.access.iter().any(|access| access.column == column && access.mode == mode)
    }

    /// Whether the system writes a column that the other one adds to, and there is no column for which it is
    /// the other way round.
    pub(super) fn writes_what_is_added_by(&self, other: &System) -> bool {
        let writes = |writer: &System, adder: &System| {
            let mut added = adder.access.iter().filter(|access| access.mode == Mode::Adds);
            added.any(|access| {
                writer.has(access.column, Mode::Writes) && !adder.has(access.column, Mode::Writes)
            })
        };
        self.shares_rows_with(other) && writes(self, other) && !writes(other, self)
    }

    pub(super) fn conflict_with(&self, other: &System) -> Option<&'static str> {
        let columns = if self.shares_rows_with(other) { &self.access[..] } else { &[] };
        let of_columns = columns.iter().flat_map(|a| other.access.iter().map(move |b| (a, b)));
        let of_packed = self.packed.iter().flat_map(|a| other.packed.iter().map(move |b| (a, b)));
        let mut pairs = of_columns.chain(of_packed);
        pairs.find(|(a, b)| a.conflicts(b)).map(|(a, _)| a.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schedule::Adds;
    use crate::world::{BodyId, Force, Mass};

    #[test]
    fn systems_that_only_add_to_a_column_need_no_order() {
        let bodies = || BodySet::new([BodyId(0)]);
        let adds = |label| System::each::<(Adds<Force>, &Mass)>(Stage::External, label, bodies(), |_, _| ());
        let writes = System::each::<(&mut Force,)>(Stage::External, "writes", bodies(), |_, _| ());
        assert_eq!(adds("one").conflict_with(&adds("other")), None);
        assert_eq!(adds("one").conflict_with(&writes), Some(Force::NAME));
    }

    #[test]
    fn systems_that_touch_packed_rows_need_an_order_whatever_their_phases_are() {
        let of = |phase, mode| {
            System::new(Stage::Rates, "of a phase", |_: &mut Step<'_>| Ok(()))
                .on_phases([PhaseId(phase)])
                .touches_packed("records", mode)
        };
        assert_eq!(of(0, Mode::Writes).conflict_with(&of(1, Mode::ReadsNear)), Some("records"));
        assert_eq!(of(0, Mode::Reads).conflict_with(&of(1, Mode::ReadsNear)), None);
    }

    #[test]
    fn systems_of_different_bodies_need_no_order() {
        let of = |bodies: &[usize]| {
            let bodies = BodySet::new(bodies.iter().map(|&k| BodyId(k)));
            System::new(Stage::External, "of bodies", |_: &mut Step<'_>| Ok(()))
                .on_bodies(bodies)
                .writes::<Force>()
        };
        assert_eq!(of(&[0, 2]).conflict_with(&of(&[1])), None);
        assert_eq!(of(&[0, 2]).conflict_with(&of(&[1, 2])), Some(Force::NAME));
        let of_all = System::new(Stage::External, "of all", |_: &mut Step<'_>| Ok(())).writes::<Force>();
        assert_eq!(of(&[0]).conflict_with(&of_all), Some(Force::NAME));
    }
}
