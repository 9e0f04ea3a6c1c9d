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
    /// serde hands nothing down to the types that it reads: the names are here while a scene is being read.
    static CURRENT: RefCell<Arc<Symbols>> = RefCell::default();
}

impl Symbols {
    /// The names of the scene that is being read on this thread; none outside of it.
    pub fn current() -> Arc<Self> {
        CURRENT.with_borrow(Arc::clone)
    }

    /// Reads something with these names.
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
