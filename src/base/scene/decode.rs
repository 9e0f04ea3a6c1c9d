//! Tree of a scene text -> typed values, by serde. Every error knows its place, and as many are found as can
//! be: an unknown field is left out, a bad entry of a list is left out, a bad field is left out and the rest
//! read again.

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

/// A text can hold that many bad fields before reading gives up to look for more.
const MAX_PASSES: usize = 64;

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
