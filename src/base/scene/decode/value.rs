//! serde's view of a value of the tree.

use serde::de::IntoDeserializer;
use serde::de::value::StrDeserializer;

use super::context::Context;
use super::error::{Error, expression_problem};
use crate::scene::Problem;
use crate::scene::expression::constant;
use crate::scene::slips::in_place_of;
use crate::scene::tree::{Node, NodeKind};

/// The name of the newtype by which an `Item` asks for its text and place instead of its value.
pub(in crate::scene) const ITEM: &str = "$meshless::Item";

/// A value of the tree that is read into a type.
#[derive(Clone, Copy)]
pub(super) struct NodeValue<'a> {
    pub node: &'a Node,
    pub context: &'a Context<'a>,
    /// Whether the name before the brackets was already used as that of a variant.
    pub unnamed: bool,
}

pub(super) type Outcome<T> = Result<T, Error>;

impl<'a> NodeValue<'a> {
    pub fn of(self, node: &'a Node) -> Self {
        Self { node, unnamed: false, ..self }
    }

    /// The result, with an error reported at this value.
    pub fn here<T>(self, result: Outcome<T>) -> Outcome<T> {
        result.map_err(|error| error.report(self.node, self.context))
    }

    pub fn wrong<T>(self, expected: impl Into<String>) -> Outcome<T> {
        self.here(Err(Error::Expected(expected.into())))
    }

    pub fn name(self) -> Option<&'a str> {
        self.node.name.as_ref().filter(|_| !self.unnamed).map(|name| name.text.as_str())
    }

    /// Reports a struct name that is not the one of the type.
    pub fn check_name(self, expected: &str) {
        if let Some(name) = self.name().filter(|&name| name != expected) {
            let problem =
                Problem::at_span(self.node.head(), format!("expected `{expected}(...)`, found `{name}`"));
            self.context.report(problem.help(in_place_of(expected, name)));
        }
    }

    /// The value of an expression in the place of a number; none if the value is not text.
    pub fn expression(self) -> Outcome<Option<f64>> {
        let symbols = self.context.symbols;
        match &self.node.kind {
            NodeKind::Text { value, .. } => constant(value, symbols).map(Some).map_err(|error| {
                self.context.report(expression_problem(self.node, &error));
                Error::Reported
            }),
            NodeKind::Bare if self.name().is_some_and(|name| symbols.parameters.contains_key(name)) => {
                let name = self.name().unwrap_or_default();
                let problem = format!("expected a number or an expression in double quotes, found `{name}`");
                let problem = Problem::at_span(self.node.head(), problem);
                self.context.report(problem.help(format!("write `\"{name}\"`")));
                Err(Error::Reported)
            }
            _ => Ok(None),
        }
    }
}

/// A name as serde reads the keys of fields and variants.
pub(super) fn key(name: &str) -> StrDeserializer<'_, Error> {
    name.into_deserializer()
}
