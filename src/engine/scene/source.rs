//! The text of a scene and the name under which messages show it.

use std::path::Path;

use super::syntax;
use super::tree::Node;
use super::{Problem, SceneError};

/// A scene text and its name, usually the path of its file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// Name that messages show, usually the path of the file.
    pub name: String,
    /// The text.
    pub text: String,
}

impl Source {
    /// A text under a name.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into() }
    }

    /// The tree of the whole text.
    ///
    /// # Errors
    /// The text is not RON.
    pub(super) fn tree(&self) -> Result<Node, Problem> {
        syntax::read(&self.text, 0)
    }

    /// The folder that files named in the scene are relative to.
    pub fn folder(&self) -> &Path {
        Path::new(&self.name).parent().unwrap_or(Path::new(""))
    }

    /// Line and column, both from 1, of a byte; the column counts characters.
    pub fn line_column(&self, byte: usize) -> (usize, usize) {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        let before = &self.text[..byte];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        (1 + before.matches('\n').count(), 1 + before[line_start..].chars().count())
    }

    /// All these problems as one error about this text.
    pub fn error(&self, problems: Vec<Problem>) -> SceneError {
        SceneError { source: self.clone(), problems }
    }
}
