//! The literals of RON: numbers, quoted and raw texts, characters.

use super::Problem;
use super::slips::attached_unit;
use super::syntax::Reader;
use super::tree::NodeKind;
use crate::notation::number;

impl Reader<'_> {
    pub(super) fn number(&mut self) -> Result<NodeKind, Problem> {
        let start = self.at;
        self.at += self.run(|c| matches!(c, '+' | '-'));
        let mut previous = ' ';
        let radix = ["0x", "0o", "0b"].iter().any(|prefix| self.rest().starts_with(prefix));
        while let Some(c) = self.peek() {
            let exponent_sign = matches!(c, '+' | '-') && matches!(previous, 'e' | 'E') && !radix;
            if !(c.is_alphanumeric() || matches!(c, '.' | '_') || exponent_sign) {
                break;
            }
            previous = c;
            self.at += c.len_utf8();
        }
        let text = &self.text[start..self.at];
        parse_number(text).ok_or_else(|| {
            let help = attached_unit(text).unwrap_or_else(|| "numbers are written 1, -2.5, 3.0e6".into());
            self.problem(start..self.at, format!("`{text}` is not a number")).help(help)
        })
    }

    pub(super) fn quoted(&mut self) -> Result<NodeKind, Problem> {
        let start = self.at;
        self.at += 1;
        let mut value = String::new();
        let mut escaped = false;
        loop {
            match self.peek() {
                None => return Err(self.unclosed_text(start, "\"")),
                Some('"') => {
                    self.at += 1;
                    let content = (!escaped).then_some(start + 1 + self.offset);
                    return Ok(NodeKind::Text { value, content });
                }
                Some('\\') => {
                    escaped = true;
                    value.extend(self.escape()?);
                }
                Some(c) => {
                    self.at += c.len_utf8();
                    value.push(c);
                }
            }
        }
    }

    pub(super) fn raw_text(&mut self) -> Result<NodeKind, Problem> {
        let start = self.at;
        self.at += 1;
        let hashes = self.run(|c| c == '#');
        self.at += hashes;
        if self.peek() != Some('"') {
            return Err(self.problem(start..self.at, "expected a raw text `r#\"...\"#`"));
        }
        self.at += 1;
        let content = self.at;
        let close = format!("\"{}", "#".repeat(hashes));
        let Some(length) = self.rest().find(&close) else {
            return Err(self.unclosed_text(start, &close));
        };
        let value = self.rest()[..length].to_owned();
        self.at += length + close.len();
        Ok(NodeKind::Text { value, content: Some(content + self.offset) })
    }

    pub(super) fn character(&mut self) -> Result<NodeKind, Problem> {
        let start = self.at;
        self.at += 1;
        let character = match self.peek() {
            Some('\\') => self.escape()?,
            Some(c) => {
                self.at += c.len_utf8();
                Some(c)
            }
            None => None,
        };
        match (character, self.peek()) {
            (Some(c), Some('\'')) => {
                self.at += 1;
                Ok(NodeKind::Character(c))
            }
            _ => Err(self
                .problem(start..start + 1, "expected one character in single quotes")
                .help("texts are written in double quotes")),
        }
    }

    /// An escape sequence; none for an escaped line end, which continues the text on the next line.
    fn escape(&mut self) -> Result<Option<char>, Problem> {
        let start = self.at;
        self.at += 1;
        let c = self.peek();
        self.at += c.map_or(0, char::len_utf8);
        let simple = match c {
            Some('n') => '\n',
            Some('r') => '\r',
            Some('t') => '\t',
            Some('0') => '\0',
            Some(c @ ('\\' | '"' | '\'')) => c,
            Some('\n' | '\r') => {
                self.at += self.run(char::is_whitespace);
                return Ok(None);
            }
            Some('x') => return self.code_point(start, self.run(|c| c.is_ascii_hexdigit()).min(2), 0),
            Some('u') if self.rest().starts_with('{') => {
                self.at += 1;
                return self.code_point(start, self.run(|c| c.is_ascii_hexdigit()), 1);
            }
            _ => {
                return Err(self
                    .problem(
                        start..self.at,
                        format!("unknown escape `{}` in a text", &self.text[start..self.at]),
                    )
                    .help("write `\\\\` for a backslash, or a raw text `r\"...\"`"));
            }
        };
        Ok(Some(simple))
    }

    fn code_point(&mut self, start: usize, digits: usize, closing: usize) -> Result<Option<char>, Problem> {
        let value = u32::from_str_radix(&self.rest()[..digits], 16).ok().and_then(char::from_u32);
        self.at += digits;
        let closed = closing == 0 || self.peek() == Some('}');
        match value {
            Some(c) if closed => {
                self.at += closing;
                Ok(Some(c))
            }
            _ => {
                Err(self
                    .problem(start..self.at, format!("`{}` is not a character", &self.text[start..self.at])))
            }
        }
    }

    fn unclosed_text(&self, start: usize, close: &str) -> Problem {
        self.problem(start..start + 1, "this text is never closed").help(format!("close it with `{close}`"))
    }
}

/// What is wrong with a value that no run can compute with, as "must be ..., found ..."; none if one can.
/// Numbers whose squares are infinite are refused too, as energies are sums of squares.
pub(super) fn refused(value: f64) -> Option<String> {
    let required = match value.abs() {
        size if size <= 1e150 => return None,
        size if size.is_finite() => "between -1e150 and 1e150",
        _ => "finite",
    };
    Some(format!("must be {required}, found {}", number(value)))
}

/// A number of RON: decimal with `_` between digits, or hexadecimal, octal, binary.
fn parse_number(text: &str) -> Option<NodeKind> {
    let unsigned = text.trim_start_matches(['+', '-']);
    if text.len() - unsigned.len() > 1 {
        return None;
    }
    let negative = text.starts_with('-');
    let digits: String = unsigned.chars().filter(|&c| c != '_').collect();
    let (radix, body) = match digits.get(..2) {
        Some("0x") => (16, &digits[2..]),
        Some("0o") => (8, &digits[2..]),
        Some("0b") => (2, &digits[2..]),
        _ => (10, digits.as_str()),
    };
    let magnitude = i128::from_str_radix(body, radix).ok().filter(|_| !body.starts_with(['+', '-']));
    let integer = magnitude.map(|value| if negative { -value } else { value });
    let magnitude: f64 = match (integer, radix) {
        (Some(integer), _) => integer.unsigned_abs() as f64,
        (None, 10) => body.parse().ok()?,
        _ => return None,
    };
    Some(NodeKind::Number { value: if negative { -magnitude } else { magnitude }, integer })
}
