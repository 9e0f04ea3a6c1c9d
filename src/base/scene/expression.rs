//! Functions of position and time that a scene writes as text: `"-0.1*smoothstep(t/0.01)"`.

mod compile;
mod functions;
mod range;

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use glam::DVec3;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use self::compile::{MAX_STACK, Op, Program};
use super::symbols::Symbols;
use super::text_fault::TextFault;

pub(super) use self::compile::{constant, words};
pub(super) use self::functions::is_reserved;

/// Names allowed in expressions beside parameters and tables, with their meaning.
pub fn expression_names() -> &'static [(&'static str, &'static str)] {
    &functions::MEANINGS
}

/// A function of x, y, z \[m\] and t \[s\], compiled once and evaluated without allocation.
///
/// It is written with numbers, `+ - * / ^`, brackets, the constants `pi` and `e` and the functions `abs sqrt
/// exp ln log10 sin cos tan asin acos atan sinh cosh tanh floor sign step ramp smoothstep` of one and `min
/// max pow atan2 mod` of two arguments. `step` is 0 for negative arguments and 1 otherwise; `ramp` and
/// `smoothstep` rise from 0 at 0 to 1 at 1, linearly and as 3 s² - 2 s³, and are constant outside. Powers
/// bind tighter than signs: `-x^2` is `-(x^2)`, and `a^b^c` is `a^(b^c)`. The parameters of the scene are
/// constants, its tables are functions of one argument.
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    program: Arc<Program>,
}

impl Expression {
    /// The constant function `value`.
    pub fn constant(value: f64) -> Self {
        Self { text: format!("{value:?}"), program: Arc::new(Program::constant(value)) }
    }

    /// The value at position `x` \[m\] and time `t` \[s\].
    pub fn eval(&self, x: DVec3, t: f64) -> f64 {
        let variables = [x.x, x.y, x.z, t];
        let mut stack = [0.0; MAX_STACK];
        let mut top = 0;
        for op in &self.program.ops {
            match *op {
                Op::Constant(value) => {
                    stack[top] = value;
                    top += 1;
                }
                Op::Variable(index) => {
                    stack[top] = variables[index];
                    top += 1;
                }
                Op::Unary(function) => stack[top - 1] = (function.at)(stack[top - 1]),
                Op::Table(index) => stack[top - 1] = self.program.tables[index].at(stack[top - 1]),
                Op::Binary(function) => {
                    top -= 1;
                    stack[top - 1] = (function.at)(stack[top - 1], stack[top]);
                }
            }
        }
        stack[0]
    }

    /// Whether the function depends on neither position nor time.
    pub fn is_constant(&self) -> bool {
        matches!(self.program.ops.as_slice(), [Op::Constant(_)])
    }

    /// Whether the function depends on time.
    pub fn depends_on_time(&self) -> bool {
        self.program.ops.iter().any(|op| matches!(op, Op::Variable(3)))
    }

    /// Whether the function depends on position.
    pub fn depends_on_place(&self) -> bool {
        self.program.ops.iter().any(|op| matches!(op, Op::Variable(0..=2)))
    }

    /// Compiles a text that may use the names of `symbols`.
    pub(super) fn with_symbols(text: &str, symbols: &Symbols) -> Result<Self, ExpressionError> {
        Ok(Self { text: text.to_owned(), program: Arc::new(compile::compile(text, symbols)?) })
    }

    /// The text that the function was compiled from.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// An error in the text of an expression, with the bytes it refers to.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message} in the expression")]
pub struct ExpressionError {
    /// First byte that the error refers to.
    pub start: usize,
    /// Byte after the last.
    pub end: usize,
    /// The error.
    pub message: String,
    /// The correction; may be empty.
    pub help: String,
}

impl ExpressionError {
    /// The error as a message of serde that carries its place.
    pub(super) fn as_text_fault(&self) -> String {
        let (bytes, message) = (self.start..self.end, self.to_string());
        TextFault { bytes, message: &message, help: &self.help }.to_string()
    }
}

impl FromStr for Expression {
    type Err = ExpressionError;

    fn from_str(text: &str) -> Result<Self, ExpressionError> {
        Self::with_symbols(text, &Symbols::default())
    }
}

impl PartialEq for Expression {
    /// Equality of the texts.
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

struct TextOrNumber;

impl Visitor<'_> for TextOrNumber {
    type Value = Expression;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or an expression in double quotes")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Expression, E> {
        Expression::with_symbols(text, &Symbols::current()).map_err(|error| E::custom(error.as_text_fault()))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Expression, E> {
        Ok(Expression::constant(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Expression, E> {
        Ok(Expression::constant(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Expression, E> {
        Ok(Expression::constant(value as f64))
    }
}

impl<'de> Deserialize<'de> for Expression {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextOrNumber)
    }
}

impl Serialize for Expression {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}

impl JsonSchema for Expression {
    fn schema_name() -> Cow<'static, str> {
        "Expression".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number, or a function of x, y, z [m] and t [s] in double quotes.",
            "type": ["number", "string"],
        })
    }
}

#[cfg(test)]
mod tests;
