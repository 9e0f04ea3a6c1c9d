//! Tree of a scene text -> typed values, by serde. Every error knows its place, and as many are found as can
//! be: an unknown field is left out, a bad entry of a list is left out, a bad field is left out and the rest
//! read again.

mod access;
mod error;
mod value;
mod variant;

pub(super) use error::{expression_problem, text_error};
pub(super) use value::ITEM;

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::sync::Arc;

use serde::de::DeserializeOwned;

use self::error::Error;
use self::value::NodeValue;
use super::Problem;
use super::symbols::Symbols;
use super::tree::Node;

/// A text can hold that many bad fields before reading gives up to look for more.
const MAX_PASSES: usize = 64;

/// Data shared while a tree is read.
struct Context<'a> {
    /// The text that the tree was read from, and the place of its first byte in the file.
    text: &'a str,
    offset: usize,
    symbols: &'a Symbols,
    problems: RefCell<Vec<Problem>>,
    /// Where the names of fields are whose values are known to be bad.
    bad_fields: RefCell<BTreeSet<usize>>,
    /// Whether something other than an unknown or repeated field was left out.
    incomplete: Cell<bool>,
}

impl<'a> Context<'a> {
    fn new(text: &'a str, offset: usize, symbols: &'a Symbols) -> Self {
        let (problems, bad_fields) = Default::default();
        Self { text, offset, symbols, problems, bad_fields, incomplete: Cell::new(false) }
    }

    /// The reported problems, in the order of the text.
    fn into_problems(self) -> Vec<Problem> {
        let mut problems = self.problems.into_inner();
        problems.sort_by_key(|problem| match &problem.at {
            super::SourcePlace::Span(span) => span.start,
            _ => 0,
        });
        problems
    }

    fn report(&self, problem: Problem) {
        let mut problems = self.problems.borrow_mut();
        if !problems.contains(&problem) {
            problems.push(problem);
        }
    }
}

/// The decoded value and the problems.
pub(super) struct Decoded<T> {
    /// The value, if it is whole but for fields that it does not have.
    pub value: Option<T>,
    pub problems: Vec<Problem>,
}

/// Reads `node`, whose text starts at byte `offset` of the file, as a `T`. With `unnamed`, the name before
/// its brackets is not looked at. Numbers may be expressions in `symbols`.
pub(super) fn decode<T: DeserializeOwned>(
    node: &Node,
    text: &str,
    offset: usize,
    unnamed: bool,
    symbols: &Arc<Symbols>,
) -> Decoded<T> {
    let context = Context::new(text, offset, symbols);
    let mut value = None;
    for _ in 0..MAX_PASSES {
        let known = context.bad_fields.borrow().len();
        let result: Result<T, Error> =
            symbols.during(|| T::deserialize(NodeValue { node, context: &context, unnamed }));
        value = result.map_err(|error| error.report(node, &context)).ok();
        if context.bad_fields.borrow().len() == known {
            break;
        }
    }
    Decoded { value: value.filter(|_| !context.incomplete.get()), problems: context.into_problems() }
}
