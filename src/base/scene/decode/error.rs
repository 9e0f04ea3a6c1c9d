//! Errors of serde until their position is known.

use std::fmt;

use serde::de::{self, Expected, Unexpected};

use super::context::Context;
use crate::scene::names::unknown;
use crate::scene::text_fault::TextFault;
use crate::scene::tree::{Node, NodeKind};
use crate::scene::{ExpressionError, Problem};

/// An error that has no position yet: it gets that of the value that reports it.
#[derive(Debug)]
pub(super) enum Error {
    /// Already reported.
    Reported,
    /// The value is not of the type that the text describes.
    Expected(String),
    /// A tuple of the wrong length.
    Length { found: usize, expected: String },
    /// A name that is none of the variants.
    Variant { found: String, known: &'static [&'static str] },
    /// A field that must be given is not.
    Missing(&'static str),
    /// Any other error, in the words of the type.
    Message(String),
}

impl Error {
    /// The error; if it is about the length of a tuple, with the number of entries found.
    pub fn with_found(self, found: usize) -> Self {
        match self {
            Self::Length { expected, .. } => Self::Length { found, expected },
            error => error,
        }
    }

    /// Reports the error at `node`.
    pub fn report(self, node: &Node, context: &Context) -> Self {
        let head = node.head();
        let problem = match self {
            Self::Reported => return Self::Reported,
            Self::Expected(expected) => {
                let message = format!("expected {expected}, found {}", node.describe());
                Problem::at_span(whole_or_head(node), message).helps(notation_help(node, &expected))
            }
            Self::Length { found, expected } => {
                let found = if found == 1 { "1 entry".into() } else { format!("{found} entries") };
                Problem::at_span(whole_or_head(node), format!("expected {expected}, found {found}"))
            }
            Self::Variant { found, known } => {
                let (message, help) = unknown("variant", &found, known);
                Problem::at_span(head, message).helps(help)
            }
            Self::Missing(field) => match node.name.as_ref().map(|name| &name.text) {
                Some(name) => Problem::at_span(head, format!("missing field `{field}` of `{name}`"))
                    .help(format!("`meshless plugins {name}` describes its fields")),
                None => Problem::at_span(head, format!("missing field `{field}`")),
            },
            Self::Message(message) => located(node, &message),
        };
        context.report(problem);
        Self::Reported
    }
}

/// Help if only the notation of the value is wrong: entries in the round brackets of a name whose value is a
/// list, a single entry without brackets, a name in quotes.
fn notation_help(node: &Node, expected: &str) -> Vec<String> {
    let help = match (&node.kind, &node.name) {
        (NodeKind::Tuple(entries), Some(name)) if entries.len() > 1 && expected == A_LIST => {
            format!("write its entries as a list: `{}([...])`", name.text)
        }
        (NodeKind::Bare, Some(name)) if expected == A_LIST => {
            format!("write it as a list of one entry: `[{}]`", name.text)
        }
        (NodeKind::Text { value, .. }, _) if expected.contains(&format!("`{value}`")) => {
            format!("write it without quotes: `{value}`")
        }
        _ => return Vec::new(),
    };
    vec![help]
}

/// The span of a value in a message: the whole value, or only its head if it is long.
fn whole_or_head(node: &Node) -> std::ops::Range<usize> {
    match node.kind {
        NodeKind::Tuple(_) | NodeKind::Fields(_) => node.span.clone(),
        _ => node.head(),
    }
}

/// The problem of an expression, at its position within the text value `node`.
pub(in crate::scene) fn expression_problem(node: &Node, error: &ExpressionError) -> Problem {
    located(node, &error.as_text_fault())
}

/// The problem of a message, at its position within a text if the message carries one.
fn located(node: &Node, message: &str) -> Problem {
    let Some(TextFault { bytes, message, help }) = TextFault::read(message) else {
        return Problem::at_span(whole_or_head(node), message);
    };
    let span = match &node.kind {
        NodeKind::Text { content: Some(content), .. } => content + bytes.start..content + bytes.end,
        _ => node.span.clone(),
    };
    let problem = Problem::at_span(span, message);
    if help.is_empty() { problem } else { problem.help(help) }
}

const A_LIST: &str = "a list `[...]`";

/// The expected type of serde, in the terms of a scene.
fn in_words(expected: &dyn Expected) -> String {
    let expected = expected.to_string();
    match expected.as_str() {
        "f64" | "f32" => "a number".into(),
        "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number".into(),
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number, zero or more".into(),
        "a boolean" => "`true` or `false`".into(),
        "a string" => "a text in double quotes".into(),
        "a sequence" => A_LIST.into(),
        "a map" => "a map `{...}`".into(),
        "option" => "a value or `None`".into(),
        other => match other.rsplit_once(' ') {
            Some(("struct", name)) => format!("`{name}(...)`"),
            Some(("enum", name)) => format!("one of the variants of {name}"),
            _ => match other.strip_prefix("a tuple of size ") {
                Some(size) => format!("a tuple `(...)` of {size} entries"),
                None => expected,
            },
        },
    }
}

impl de::Error for Error {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::Message(message.to_string())
    }

    fn invalid_type(_: Unexpected, expected: &dyn Expected) -> Self {
        Self::Expected(in_words(expected))
    }

    fn invalid_value(_: Unexpected, expected: &dyn Expected) -> Self {
        Self::Expected(in_words(expected))
    }

    fn invalid_length(found: usize, expected: &dyn Expected) -> Self {
        Self::Length { found, expected: in_words(expected) }
    }

    fn unknown_variant(found: &str, known: &'static [&'static str]) -> Self {
        Self::Variant { found: found.into(), known }
    }

    fn missing_field(field: &'static str) -> Self {
        Self::Missing(field)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self:?}")
    }
}

impl std::error::Error for Error {}
