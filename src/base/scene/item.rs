//! An item of a scene whose type a registry knows by name: a material, formulation, plugin, condition,
//! contact law.

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use ron::value::RawValue;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeOwned, Error as _, SeqAccess, Visitor};
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::decode::{self, ITEM};
use super::symbols::Symbols;
use super::tree::{Node, NodeKind};
use super::{Problem, path, syntax};

/// A name with or without parameters, `NeoHookean(density: 1.0)` or `hourglass_control`, whose type is found
/// by the name in a registry. Until then it keeps its text and its position in the file.
#[derive(Clone, Debug)]
pub struct Item {
    name: String,
    text: String,
    start: usize,
    /// The names that its expressions may use.
    symbols: Arc<Symbols>,
}

impl Item {
    /// An item from its text; `start` is the place of its first byte in the file.
    fn read(text: &str, start: usize) -> Result<Self, Problem> {
        let node = syntax::read(text, start)?;
        match (node.name, node.kind) {
            (Some(name), NodeKind::Bare | NodeKind::Fields(_) | NodeKind::Tuple(_)) => {
                Ok(Self { name: name.text, text: text.to_owned(), start, symbols: Symbols::current() })
            }
            _ => Err(Problem::at_span(node.span, "expected a name, with or without parameters")),
        }
    }

    /// A name without parameters and without a position in a file: a default.
    pub(super) fn bare(name: &str) -> Self {
        Self { name: name.to_owned(), text: name.to_owned(), start: 0, symbols: Arc::default() }
    }

    /// The name by which a registry knows the item.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text as the scene has it, name included.
    pub fn text(&self) -> &str {
        &self.text
    }

    fn tree(&self) -> Result<Node, Problem> {
        syntax::read(&self.text, self.start)
    }

    /// The parameters as a `T`. A bare name and empty brackets yield a `T` with all defaults.
    ///
    /// # Errors
    /// All problems with the parameters, each at its position in the file.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, Vec<Problem>> {
        let node = self.tree().map_err(|problem| vec![problem])?;
        let decoded = decode::decode(&node, &self.text, self.start, true, &self.symbols);
        match decoded.value {
            Some(value) if decoded.problems.is_empty() => Ok(value),
            _ => Err(decoded.problems),
        }
    }

    /// A problem with the name itself, such as an unknown name.
    pub fn problem_with_name(&self, message: impl Into<String>) -> Problem {
        Problem::at_span(self.start..self.start + self.name.len(), message)
    }

    /// A problem with a parameter, such as `poisson` or `hardening.modulus`; if the parameter is not written,
    /// it is shown at the item. `help` is the correction; it may be empty.
    pub fn problem(&self, parameter: &str, message: impl Into<String>, help: impl Into<String>) -> Problem {
        let at = self.tree().ok().and_then(|node| path::exact(&node, parameter));
        let at = at.unwrap_or(self.start..self.start + self.name.len());
        let problem = Problem::at_span(at, message);
        let help = help.into();
        if help.is_empty() { problem } else { problem.help(help) }
    }
}

impl PartialEq for Item {
    /// Equality of the texts, wherever they are.
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl FromStr for Item {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        Self::read(text.trim(), 0)
    }
}

struct Parts;

impl<'de> Visitor<'de> for Parts {
    type Value = Item;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a name, with or without parameters, such as `name` or `name(parameter: 1.0)`")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Item, A::Error> {
        let start: usize = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let text: String = seq.next_element()?.ok_or_else(|| A::Error::invalid_length(1, &self))?;
        Item::read(&text, start).map_err(|problem| A::Error::custom(problem.message))
    }
}

impl<'de> Deserialize<'de> for Item {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_newtype_struct(ITEM, Parts)
    }
}

impl Serialize for Item {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        RawValue::from_ron(&self.text).map_err(S::Error::custom)?.serialize(serializer)
    }
}

impl JsonSchema for Item {
    fn schema_name() -> Cow<'static, str> {
        "Item".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A name with or without parameters: `name` or `name(parameter: 1.0)`.",
            "x-item": true,
        })
    }
}
