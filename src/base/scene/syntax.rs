//! The grammar of RON, from text to tree. Reading ends at the first error, since the text after it cannot be
//! interpreted.

use std::ops::Range;

use super::Problem;
use super::slips;
use super::tree::{Node, NodeKind, StructField, Word};

/// Maximum nesting depth, beyond that of any scene, so that no text can exhaust the stack.
const MAX_DEPTH: usize = 100;

/// Reads one value that fills `text`; all positions are counted from `offset`.
pub(super) fn read(text: &str, offset: usize) -> Result<Node, Problem> {
    let mut reader = Reader { text, offset, at: 0, depth: 0, last_text: 0..0 };
    reader.skip_attributes()?;
    let node = reader.value()?;
    reader.skip_space()?;
    match reader.peek() {
        None => Ok(node),
        Some(_) => Err(reader
            .unexpected("the end of the text")
            .help("everything belongs inside the brackets of one value")),
    }
}

pub(super) struct Reader<'a> {
    pub(super) text: &'a str,
    pub(super) offset: usize,
    pub(super) at: usize,
    depth: usize,
    /// Bytes of the last text in quotes.
    last_text: Range<usize>,
}

impl<'a> Reader<'a> {
    pub(super) fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    pub(super) fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    pub(super) fn span(&self, range: Range<usize>) -> Range<usize> {
        range.start + self.offset..range.end + self.offset
    }

    pub(super) fn problem(&self, range: Range<usize>, message: impl Into<String>) -> Problem {
        Problem::at_span(self.span(range), message)
    }

    /// The length in bytes of the leading characters that satisfy `fits`.
    pub(super) fn run(&self, fits: impl Fn(char) -> bool) -> usize {
        self.rest().find(|c| !fits(c)).unwrap_or(self.rest().len())
    }

    fn unexpected(&self, expected: &str) -> Problem {
        let Some(found) = self.peek() else {
            let end = self.text.trim_end().len();
            let found = if end == 0 { "an empty text" } else { "the end of the text" };
            return self.problem(end..end, format!("expected {expected}, found {found}"));
        };
        let length = self.run(is_word).max(found.len_utf8());
        let found = &self.rest()[..length];
        self.problem(
            self.at..self.at + length,
            format!("expected {expected}, found `{}`", found.escape_debug()),
        )
    }

    fn skip_space(&mut self) -> Result<(), Problem> {
        loop {
            self.at += self.run(|c| c.is_whitespace() || matches!(c, '\u{200e}' | '\u{200f}' | '\u{feff}'));
            if self.rest().starts_with("//") {
                self.at += self.run(|c| c != '\n');
            } else if self.rest().starts_with("/*") {
                self.skip_block_comment()?;
            } else {
                return Ok(());
            }
        }
    }

    fn skip_block_comment(&mut self) -> Result<(), Problem> {
        let start = self.at;
        let mut depth = 0;
        loop {
            let rest = self.rest();
            if rest.starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if rest.starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return Ok(());
                }
            } else if let Some(c) = rest.chars().next() {
                self.at += c.len_utf8();
            } else {
                return Err(self
                    .problem(start..start + 2, "this comment is never closed")
                    .help("close it with `*/`"));
            }
        }
    }

    /// `#![enable(...)]` at the start is accepted: the extensions it can enable are always on.
    fn skip_attributes(&mut self) -> Result<(), Problem> {
        self.skip_space()?;
        while self.rest().starts_with("#![") {
            match self.rest().find(']') {
                Some(end) => self.at += end + 1,
                None => return Err(self.problem(self.at..self.at + 3, "this `#![` is never closed")),
            }
            self.skip_space()?;
        }
        Ok(())
    }

    fn value(&mut self) -> Result<Node, Problem> {
        self.skip_space()?;
        if self.depth == MAX_DEPTH {
            return Err(
                self.problem(self.at..self.at + 1, format!("values nest deeper than {MAX_DEPTH} levels"))
            );
        }
        self.depth += 1;
        let node = self.value_here();
        self.depth -= 1;
        node
    }

    fn value_here(&mut self) -> Result<Node, Problem> {
        let start = self.at;
        let rest = self.rest();
        let unnamed = |reader: &Self, open, kind| {
            Ok(Node { span: reader.span(start..reader.at), name: None, open: open + reader.offset, kind })
        };
        match self.peek() {
            Some('(') => self.brackets(None, start),
            Some('[') => {
                let list = self.entries(']', Self::value)?;
                unnamed(self, start + 1, NodeKind::List(list))
            }
            Some('{') => {
                let map = self.entries('}', |reader| {
                    let key = reader.value()?;
                    reader.expect(':', "`:` and the value of this entry")?;
                    Ok((key, reader.value()?))
                })?;
                unnamed(self, start + 1, NodeKind::Map(map))
            }
            Some('"') => {
                let text = self.quoted()?;
                self.last_text = start..self.at;
                unnamed(self, start, text)
            }
            Some('r') if rest.starts_with("r\"") || rest.starts_with("r#") => {
                let text = self.raw_text()?;
                unnamed(self, start, text)
            }
            Some('\'') => {
                let character = self.character()?;
                unnamed(self, start, character)
            }
            Some(c) if c.is_ascii_digit() || matches!(c, '+' | '-' | '.') => {
                let number = self.number()?;
                unnamed(self, start, number)
            }
            Some(c) if starts_word(c) => {
                let word = self.word();
                if matches!(word.text.as_str(), "inf" | "NaN") {
                    let value = if word.text == "inf" { f64::INFINITY } else { f64::NAN };
                    return unnamed(self, start, NodeKind::Number { value, integer: None });
                }
                let end = self.at;
                self.skip_space()?;
                if self.peek() == Some('(') {
                    return self.brackets(Some(word), start);
                }
                self.at = end;
                Ok(Node {
                    span: word.span.clone(),
                    open: word.span.start,
                    name: Some(word),
                    kind: NodeKind::Bare,
                })
            }
            _ => Err(self.unexpected("a value")),
        }
    }

    /// Content of round brackets: fields when it starts with `name:`, else a tuple.
    fn brackets(&mut self, name: Option<Word>, start: usize) -> Result<Node, Problem> {
        let open = self.at + 1 + self.offset;
        let back = self.at;
        self.at += 1;
        self.skip_space()?;
        let named = self.peek().is_some_and(starts_word) && {
            self.word();
            self.skip_space()?;
            self.peek() == Some(':')
        };
        self.at = back;
        let kind = if named {
            NodeKind::Fields(self.entries(')', |reader| {
                reader.skip_space()?;
                if !reader.peek().is_some_and(starts_word) {
                    let problem = reader.unexpected("the name of a field");
                    let is_digit = reader.peek().is_some_and(|c| c.is_ascii_digit());
                    let help = is_digit.then(|| {
                        "a number has a decimal point, `1.5`; a vector has brackets, `(1, 5)`".into()
                    });
                    return Err(problem.helps(help));
                }
                let name = reader.word();
                reader.expect(':', &format!("`:` and the value of `{}`", name.text))?;
                Ok(StructField { name, value: reader.value()? })
            })?)
        } else {
            NodeKind::Tuple(self.entries(')', Self::value)?)
        };
        Ok(Node { span: self.span(start..self.at), name, open, kind })
    }

    /// Entries between brackets, separated by commas.
    fn entries<T>(
        &mut self,
        close: char,
        mut entry: impl FnMut(&mut Self) -> Result<T, Problem>,
    ) -> Result<Vec<T>, Problem> {
        let open = self.at;
        self.at += 1;
        let mut entries = Vec::new();
        loop {
            self.skip_space()?;
            match self.peek() {
                None | Some(')' | ']' | '}') if self.peek() != Some(close) => {
                    return Err(self.unclosed(open, close));
                }
                Some(c) if c == close => break,
                _ => entries.push(entry(self)?),
            }
            self.skip_space()?;
            match self.peek() {
                Some(',') => self.at += 1,
                Some(c) if c == close => break,
                None | Some(')' | ']' | '}') => return Err(self.unclosed(open, close)),
                Some(_) => return Err(self.not_separated(open, close)),
            }
        }
        self.at += 1;
        Ok(entries)
    }

    /// The problem of an entry in the bracket at `open` that neither a comma nor the closing bracket follows.
    fn not_separated(&self, open: usize, close: char) -> Problem {
        let bracket = &self.text[open..open + 1];
        let text = self.last_text.clone();
        if self.text[text.clone()].contains('\n') && self.text[text.end..self.at].trim().is_empty() {
            return self
                .problem(text.start..text.start + 1, "this text is never closed")
                .help("close it with `\"` in its line: it goes on to the next `\"`");
        }
        if self.peek() == Some(':') && !self.rest().starts_with("::") {
            let before = self.text[..self.at].trim_end();
            let field = &before[before.trim_end_matches(is_word).len()..];
            return self
                .problem(open..open + 1, format!("this `{bracket}` is never closed"))
                .help(format!("a `{close}` is missing before the field `{field}`"));
        }
        let problem = self.unexpected(&format!("`,` or `{close}`"));
        problem.helps(slips::after_number(&self.text[..self.at], self.rest()))
    }

    /// The problem of a bracket at `open` that is not closed before the text or an outer bracket ends.
    fn unclosed(&self, open: usize, close: char) -> Problem {
        let bracket = &self.text[open..open + 1];
        let problem = self.problem(open..open + 1, format!("this `{bracket}` is never closed"));
        match self.peek() {
            Some(other) => {
                let line = 1 + self.text[..self.at].matches('\n').count();
                let place = if self.offset == 0 { format!(" in line {line}") } else { String::new() };
                problem.help(format!("a `{close}` is missing before the `{other}`{place}"))
            }
            None => problem.help(format!("a `{close}` is missing after its last entry")),
        }
    }

    fn expect(&mut self, c: char, what: &str) -> Result<(), Problem> {
        self.skip_space()?;
        if self.peek() != Some(c) {
            return Err(self.unexpected(what));
        }
        self.at += c.len_utf8();
        Ok(())
    }

    fn word(&mut self) -> Word {
        let start = self.at;
        self.at += self.run(is_word);
        Word { text: self.text[start..self.at].into(), span: self.span(start..self.at) }
    }
}

fn starts_word(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}
