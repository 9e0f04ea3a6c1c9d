//! Compiles the text of an expression to a program for a stack machine; constants are folded.

use std::sync::Arc;

use super::ExpressionError;
use super::functions::{
    BINARY, Binary, CONSTANTS, MINUS, NEGATIVE, OVER, PLUS, POWER, TIMES, UNARY, Unary, VARIABLES,
};
use crate::scene::literal::refused;
use crate::scene::names::nearest;
use crate::scene::slips::is_unit;
use crate::scene::symbols::Symbols;
use crate::scene::table::Interpolation;

/// Size of the stack of an evaluation.
pub(super) const MAX_STACK: usize = 32;
/// Maximum nesting depth of brackets, signs and powers.
const MAX_DEPTH: usize = 64;

/// One instruction of the program.
#[derive(Clone, Copy, Debug)]
pub(super) enum Op {
    Constant(f64),
    Variable(usize),
    Unary(Unary),
    Binary(Binary),
    /// Interpolates in the table with this index.
    Table(usize),
}

/// A compiled expression.
#[derive(Debug)]
pub(super) struct Program {
    pub ops: Vec<Op>,
    pub tables: Vec<Arc<Interpolation>>,
}

impl Program {
    /// The program that returns a constant.
    pub fn constant(value: f64) -> Self {
        Self { ops: vec![Op::Constant(value)], tables: Vec::new() }
    }
}

/// Compiles an expression that may use the names of `symbols`.
///
/// # Errors
/// The text is not an expression, or its value is constant and not finite.
pub(super) fn compile(text: &str, symbols: &Symbols) -> Result<Program, ExpressionError> {
    run(text, symbols, &VARIABLES)
}

/// The value of an expression in the place of a number: it cannot depend on position and time.
///
/// # Errors
/// The text is not such an expression, or its value is not finite.
pub(in crate::scene) fn constant(text: &str, symbols: &Symbols) -> Result<f64, ExpressionError> {
    let Program { ops, .. } = run(text, symbols, &[])?;
    match ops.as_slice() {
        [Op::Constant(value)] => Ok(*value),
        _ => Err(ExpressionError {
            start: 0,
            end: text.len(),
            message: "no constant value".into(),
            help: String::new(),
        }),
    }
}

/// The names in a text; the exponent of a number, as in `2e3`, is not a name.
pub(in crate::scene) fn words(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.'));
    words.filter(|word| word.starts_with(|c: char| c.is_alphabetic() || c == '_'))
}

fn run(
    text: &str,
    symbols: &Symbols,
    variables: &'static [&'static str],
) -> Result<Program, ExpressionError> {
    let mut compiler = Compiler {
        text,
        symbols,
        variables,
        at: 0,
        program: Vec::new(),
        tables: Vec::new(),
        height: 0,
        depth: 0,
    };
    compiler.sum()?;
    if compiler.peek().is_some() {
        return Err(compiler.unexpected("an operator or the end"));
    }
    match compiler.program.as_slice() {
        [Op::Constant(value)] if let Some(fault) = refused(*value) => {
            Err(compiler.error(0..text.len(), format!("the value {fault}"), ""))
        }
        _ => Ok(Program { ops: compiler.program, tables: compiler.tables }),
    }
}

struct Compiler<'a> {
    text: &'a str,
    symbols: &'a Symbols,
    variables: &'static [&'static str],
    at: usize,
    program: Vec<Op>,
    tables: Vec<Arc<Interpolation>>,
    height: usize,
    depth: usize,
}

type Outcome = Result<(), ExpressionError>;

impl Compiler<'_> {
    fn error(
        &self,
        range: std::ops::Range<usize>,
        message: impl Into<String>,
        help: &str,
    ) -> ExpressionError {
        ExpressionError { start: range.start, end: range.end, message: message.into(), help: help.into() }
    }

    fn unexpected(&mut self, expected: &str) -> ExpressionError {
        match self.peek() {
            Some(c) => {
                let range = self.at..self.at + c.len_utf8();
                self.error(range, format!("expected {expected}, found `{c}`"), "")
            }
            None => self.error(self.at..self.at, format!("expected {expected}, found nothing more"), ""),
        }
    }

    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        self.at += if found { c.len_utf8() } else { 0 };
        found
    }

    fn run(&mut self, fits: impl Fn(char) -> bool) -> &str {
        let start = self.at;
        let rest = &self.text[start..];
        self.at += rest.find(|c| !fits(c)).unwrap_or(rest.len());
        &self.text[start..self.at]
    }

    fn push(&mut self, op: Op) -> Outcome {
        self.height += 1;
        if self.height > MAX_STACK {
            return Err(self.error(
                0..self.text.len(),
                "too many values pending at once",
                "split it or drop brackets",
            ));
        }
        self.program.push(op);
        Ok(())
    }

    fn unary(&mut self, function: Unary) {
        match self.program.last_mut() {
            Some(Op::Constant(value)) => *value = (function.at)(*value),
            _ => self.program.push(Op::Unary(function)),
        }
    }

    fn table(&mut self, table: Arc<Interpolation>) {
        if let Some(Op::Constant(value)) = self.program.last_mut() {
            *value = table.at(*value);
        } else {
            self.program.push(Op::Table(self.tables.len()));
            self.tables.push(table);
        }
    }

    fn binary(&mut self, function: Binary) {
        self.height -= 1;
        match *self.program.as_slice() {
            [.., Op::Constant(a), Op::Constant(b)] => {
                self.program.truncate(self.program.len() - 2);
                self.program.push(Op::Constant((function.at)(a, b)));
            }
            _ => self.program.push(Op::Binary(function)),
        }
    }

    fn sum(&mut self) -> Outcome {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.error(self.at..self.at, "brackets nested too deeply", ""));
        }
        self.product()?;
        loop {
            if self.take('+') {
                self.product()?;
                self.binary(PLUS);
            } else if self.take('-') {
                self.product()?;
                self.binary(MINUS);
            } else {
                self.depth -= 1;
                return Ok(());
            }
        }
    }

    fn product(&mut self) -> Outcome {
        self.signed()?;
        loop {
            if self.take('*') {
                if self.text[self.at..].starts_with('*') {
                    return Err(self.error(
                        self.at - 1..self.at + 1,
                        "found `**`",
                        "powers are written `a^b`",
                    ));
                }
                self.signed()?;
                self.binary(TIMES);
            } else if self.take('/') {
                self.signed()?;
                self.binary(OVER);
            } else {
                return Ok(());
            }
        }
    }

    fn signed(&mut self) -> Outcome {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.error(self.at..self.at, "signs or powers nested too deeply", ""));
        }
        if self.take('-') {
            self.signed()?;
            self.unary(NEGATIVE);
        } else if self.take('+') {
            self.signed()?;
        } else {
            self.power()?;
        }
        self.depth -= 1;
        Ok(())
    }

    fn power(&mut self) -> Outcome {
        self.atom()?;
        if self.take('^') {
            self.signed()?;
            self.binary(POWER);
        }
        Ok(())
    }

    fn atom(&mut self) -> Outcome {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                self.sum()?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            _ => Err(self.unexpected("a value")),
        }
    }

    fn close(&mut self) -> Outcome {
        if self.take(')') { Ok(()) } else { Err(self.unexpected("`)`")) }
    }

    fn number(&mut self) -> Outcome {
        let start = self.at;
        self.run(|c| c.is_ascii_digit() || c == '.');
        if matches!(self.text.as_bytes().get(self.at), Some(b'e' | b'E')) {
            let digits = self.text[self.at + 1..].trim_start_matches(['+', '-']);
            if digits.starts_with(|c: char| c.is_ascii_digit()) {
                self.at = self.text.len() - digits.len();
                self.run(|c| c.is_ascii_digit());
            }
        }
        let text = &self.text[start..self.at];
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => self.push(Op::Constant(value)),
            _ => Err(self.error(
                start..self.at,
                format!("`{text}` is not a number"),
                "numbers are written 1, 2.5, 3e-6",
            )),
        }
    }

    fn name(&mut self) -> Outcome {
        let start = self.at;
        let name = self.run(|c| c.is_alphanumeric() || c == '_').to_owned();
        let range = start..self.at;
        if let Some(index) = self.variables.iter().position(|variable| *variable == name) {
            return self.push(Op::Variable(index));
        }
        if VARIABLES.contains(&name.as_str()) {
            let message = format!("the number must be constant, found `{name}`");
            return Err(self.error(
                range,
                message,
                "it may be made of numbers, parameters and functions of them",
            ));
        }
        if let Some(value) = self.symbols.parameters.get(&name) {
            return self.push(Op::Constant(*value));
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            return self.push(Op::Constant(*value));
        }
        let unary = UNARY.iter().find(|(function, _)| *function == name);
        let binary = BINARY.iter().find(|(function, _)| *function == name);
        let table = self.symbols.tables.get(&name).cloned();
        if unary.is_none() && binary.is_none() && table.is_none() {
            return Err(self.unknown(range, &name));
        }
        let arguments = self.arguments(range.clone(), &name)?;
        match (unary, binary, table, arguments) {
            (Some((_, function)), _, _, 1) => self.unary(*function),
            (_, Some((_, function)), _, 2) => self.binary(*function),
            (_, _, Some(table), 1) => self.table(table),
            _ => {
                let wanted = if binary.is_none() { "one argument" } else { "two arguments" };
                return Err(self.error(range, format!("`{name}` takes {wanted}, found {arguments}"), ""));
            }
        }
        Ok(())
    }

    /// Compiles the arguments of a function and returns how many there are.
    fn arguments(&mut self, name: std::ops::Range<usize>, function: &str) -> Result<usize, ExpressionError> {
        if !self.take('(') {
            return Err(self.error(
                name,
                format!("`{function}` without its argument"),
                "functions are written `sin(x)`",
            ));
        }
        let mut count = 0;
        loop {
            self.sum()?;
            count += 1;
            if !self.take(',') {
                self.close()?;
                return Ok(count);
            }
        }
    }

    fn unknown(&self, range: std::ops::Range<usize>, name: &str) -> ExpressionError {
        let mut known: Vec<&str> = self.symbols.names().collect();
        known.extend(self.variables);
        known.extend(CONSTANTS.iter().map(|(name, _)| *name));
        known.extend(UNARY.iter().map(|(name, _)| *name));
        known.extend(BINARY.iter().map(|(name, _)| *name));
        let near = nearest(name, &known).map(|near| format!("did you mean `{near}`? ")).unwrap_or_default();
        let unit = if is_unit(name) { "numbers are in SI units, which are not written; " } else { "" };
        let help = format!("{unit}{near}known here: {}", known.join(" "));
        self.error(range, format!("unknown name `{name}`"), &help)
    }
}
