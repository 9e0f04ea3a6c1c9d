//! Problems found while a tree is read.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use crate::scene::symbols::Symbols;
use crate::scene::{Problem, SourcePlace};

/// Data shared while a tree is read.
pub(super) struct Context<'a> {
    /// The text that the tree was read from, and the place of its first byte in the file.
    pub text: &'a str,
    pub offset: usize,
    pub symbols: &'a Symbols,
    pub problems: RefCell<Vec<Problem>>,
    /// Positions of the names of fields whose values are known to be bad.
    pub bad_fields: RefCell<BTreeSet<usize>>,
    /// Whether anything but an unknown or repeated field was skipped.
    pub incomplete: Cell<bool>,
}

impl<'a> Context<'a> {
    pub fn new(text: &'a str, offset: usize, symbols: &'a Symbols) -> Self {
        let (problems, bad_fields) = Default::default();
        Self { text, offset, symbols, problems, bad_fields, incomplete: Cell::new(false) }
    }

    /// The reported problems, in the order of the text.
    pub fn into_problems(self) -> Vec<Problem> {
        let mut problems = self.problems.into_inner();
        problems.sort_by_key(|problem| match &problem.at {
            SourcePlace::Span(span) => span.start,
            _ => 0,
        });
        problems
    }

    pub fn report(&self, problem: Problem) {
        let mut problems = self.problems.borrow_mut();
        if !problems.contains(&problem) {
            problems.push(problem);
        }
    }
}
