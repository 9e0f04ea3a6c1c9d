//! The declared access of the running system to columns and shared data, and its first undeclared access.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use thiserror::Error;

use super::column::Column;

/// Kind of access of a system to a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// It reads the column.
    Reads,
    /// It reads the column in rows of neighbours too.
    ReadsNear,
    /// It overwrites or changes the column.
    Writes,
    /// It adds to an accumulator; additions commute, and run in the order of the scene.
    Adds,
}

impl Mode {
    /// All modes, in words.
    pub(crate) const VERBS: [(Self, &'static str); 4] = [
        (Self::Reads, "reads"),
        (Self::ReadsNear, "reads near"),
        (Self::Writes, "writes"),
        (Self::Adds, "adds to"),
    ];

    /// Whether the declaration allows the access: writing and adding are the same for a borrowed column, and
    /// a declared writer may read.
    fn allows(self, done: Self) -> bool {
        match done {
            Self::Reads => true,
            Self::ReadsNear => self == Self::ReadsNear,
            Self::Writes | Self::Adds => matches!(self, Self::Writes | Self::Adds),
        }
    }
}

/// A declared access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Name of the column.
    pub column: &'static str,
    /// Kind of access.
    pub mode: Mode,
}

impl Access {
    /// Whether two systems with these accesses need a stated order.
    pub fn conflicts(&self, other: &Access) -> bool {
        let reads = |mode| matches!(mode, Mode::Reads | Mode::ReadsNear);
        let both_add = self.mode == Mode::Adds && other.mode == Mode::Adds;
        self.column == other.column && !both_add && !(reads(self.mode) && reads(other.mode))
    }
}

/// Declared access of a system to columns and shared data.
#[derive(Clone, Debug)]
pub struct Declared {
    /// Label of the system.
    pub system: String,
    /// Its accesses; none where it may read every column, as outputs do.
    pub access: Option<Vec<Access>>,
}

/// A system has touched a column, or rows that systems share, in a way that it has not declared.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("system `{system}` touches {what} and has not declared it: add `{declaration}` to the system")]
pub struct Undeclared {
    /// Label of the system.
    pub system: String,
    /// Accessed data, in words.
    pub what: String,
    /// The missing declaration.
    pub declaration: String,
}

/// The running system, the declarations of the systems, and the first undeclared access.
#[derive(Debug)]
pub(crate) struct Watch {
    declared: Vec<Declared>,
    /// Number of the system that runs; beyond the last one where none does.
    running: AtomicUsize,
    first: OnceLock<Undeclared>,
}

impl Watch {
    const NONE: usize = usize::MAX;

    pub fn new(declared: Vec<Declared>) -> Self {
        Self { declared, running: AtomicUsize::new(Self::NONE), first: OnceLock::new() }
    }

    /// System `k` runs from now on, or none.
    pub fn enter(&self, k: Option<usize>) {
        self.running.store(k.unwrap_or(Self::NONE), Ordering::Relaxed);
    }

    pub fn first(&self) -> Option<&Undeclared> {
        self.first.get()
    }

    /// Notes the access if the system that runs has not declared it.
    pub fn touches<T: Column>(&self, done: Mode) {
        let Some(system) = self.undeclared_in(&[T::NAME], done) else { return };
        let declaration = match done {
            Mode::Reads => "reads",
            Mode::ReadsNear => "reads_near",
            Mode::Writes | Mode::Adds => "writes",
        };
        let path = std::any::type_name::<T>();
        let type_name = path.rsplit("::").next().unwrap_or(path);
        self.note(system, format!("the column `{}`", T::NAME), format!(".{declaration}::<{type_name}>()"));
    }

    /// Notes the access to a value that systems share if the one that runs has declared none of the names of
    /// its rows.
    pub fn touches_shared(&self, rows: &'static [&'static str], done: Mode) {
        let Some(system) = self.undeclared_in(rows, done) else { return };
        let names: Vec<String> = rows.iter().map(|name| format!("`{name}`")).collect();
        let what = format!("{} of what systems share", names.join(" or "));
        self.note(system, what, format!(".touches_packed({:?}, Mode::{done:?})", rows[0]));
    }

    /// The system that runs, if it has declared that access to none of these names.
    fn undeclared_in(&self, names: &[&str], done: Mode) -> Option<&Declared> {
        let system = self.declared.get(self.running.load(Ordering::Relaxed))?;
        let allowed = match &system.access {
            Some(access) => access.iter().any(|a| names.contains(&a.column) && a.mode.allows(done)),
            None => matches!(done, Mode::Reads | Mode::ReadsNear),
        };
        (!allowed).then_some(system)
    }

    #[cold]
    fn note(&self, system: &Declared, what: String, declaration: String) {
        let _ = self.first.set(Undeclared { system: system.system.clone(), what, declaration });
    }
}
