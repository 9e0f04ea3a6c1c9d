//! Problems of texts within a scene, such as expressions, written as messages of serde, whose errors carry
//! only text.

use std::fmt;
use std::ops::Range;

/// A problem at some bytes of a text value.
pub(super) struct TextFault<'a> {
    pub bytes: Range<usize>,
    pub message: &'a str,
    /// The correction; may be empty.
    pub help: &'a str,
}

const MARK: char = '\u{1f}';

impl fmt::Display for TextFault<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bytes: Range { start, end }, message, help } = self;
        write!(f, "{MARK}{start}{MARK}{end}{MARK}{message}{MARK}{help}")
    }
}

impl<'a> TextFault<'a> {
    /// The problem that was written as a message of serde; none for any other message.
    pub fn read(message: &'a str) -> Option<Self> {
        let parts: Vec<&str> = message.split(MARK).collect();
        let &["", start, end, message, help] = parts.as_slice() else { return None };
        Some(Self { bytes: start.parse().ok()?..end.parse().ok()?, message, help })
    }
}
