//! The names that a scene defines for its expressions: parameters, which are numbers, and tables, which are
//! functions.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::expression::is_reserved;
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

/// Problem of a name that a scene defines: the message and the correction.
pub(super) fn fault_of_name(name: &str) -> Option<(String, String)> {
    let fits = |c: char| c.is_alphanumeric() || c == '_';
    if is_reserved(name) {
        let message = format!("`{name}` is already a variable, constant or function of expressions");
        return Some((message, format!("choose another name, such as `{name}_0`")));
    }
    let starts = name.chars().next().is_some_and(|c| c.is_alphabetic() || c == '_');
    if starts && name.chars().all(fits) && name.len() <= 100 {
        return None;
    }
    let help =
        "names consist of letters, digits and `_`, do not start with a digit and have at most 100 bytes";
    Some(("the name cannot stand in an expression".to_owned(), help.to_owned()))
}
