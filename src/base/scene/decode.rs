//! Converts the tree of a scene text into typed values, by serde. Every error has its position, and reading
//! continues after most errors: an unknown field, a bad entry of a list and a bad field are skipped, and the
//! rest is read again.

mod access;
mod context;
mod deserializer;
mod error;
mod value;
mod variant;

pub(super) use error::expression_problem;
pub(super) use value::ITEM;

use std::sync::Arc;

use serde::de::DeserializeOwned;

use self::context::Context;
use self::error::Error;
use self::value::NodeValue;
use super::Problem;
use super::symbols::Symbols;
use super::tree::Node;

/// Maximum number of passes, each of which finds one more bad field.
const MAX_PASSES: usize = 64;

/// The decoded value and the problems.
pub(super) struct Decoded<T> {
    /// The value, if it is complete apart from unknown fields.
    pub value: Option<T>,
    pub problems: Vec<Problem>,
}

/// Reads `node`, whose text starts at byte `offset` of the file, as a `T`. With `unnamed`, the name before
/// its brackets is ignored. Numbers may be expressions in `symbols`.
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
