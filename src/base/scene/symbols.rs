//! The names that a scene defines for its expressions: parameters, which are numbers, and tables, which are
//! functions.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::table::Interpolation;

/// The parameters and tables of a scene.
#[derive(Debug, Default)]
pub(super) struct Symbols {
    /// Numbers by name.
    pub parameters: BTreeMap<String, f64>,
    /// Functions of one variable by name.
    pub tables: BTreeMap<String, Arc<Interpolation>>,
}

thread_local! {
    /// serde passes no context to the types that it reads, so that the names are here while a scene is read.
    static CURRENT: RefCell<Arc<Symbols>> = RefCell::default();
}

impl Symbols {
    /// The names of the scene that is being read on this thread; none while no scene is read.
    pub fn current() -> Arc<Self> {
        CURRENT.with_borrow(Arc::clone)
    }

    /// Calls `read` with these names.
    pub fn during<T>(self: &Arc<Self>, read: impl FnOnce() -> T) -> T {
        let before = CURRENT.replace(Arc::clone(self));
        let result = read();
        CURRENT.replace(before);
        result
    }

    /// All names, for suggestions.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parameters.keys().chain(self.tables.keys()).map(String::as_str)
    }
}
