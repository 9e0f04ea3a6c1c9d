//! The text of a scene and the name under which messages show it.

use std::path::Path;

use super::syntax;
use super::tree::{Node, NodeKind};
use super::{Problem, SceneError};

/// A scene text and its name, usually the path of its file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// Name that messages show, usually the path of the file.
    pub name: String,
    /// The text.
    pub text: String,
    /// Path and value of each override of the text.
    pub(super) settings: Vec<(String, String)>,
}

impl Source {
    /// A text under a name.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), settings: Vec::new() }
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

    /// The files that the scene names, as it writes them: the values of all fields `file`. None where the
    /// text is not RON.
    pub fn files(&self) -> Vec<String> {
        let mut files = Vec::new();
        if let Ok(root) = self.tree() {
            collect_files(&root, &mut files);
        }
        files.sort_unstable();
        files.dedup();
        files
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

fn collect_files(node: &Node, files: &mut Vec<String>) {
    match &node.kind {
        NodeKind::Fields(fields) => {
            for field in fields {
                match &field.value.kind {
                    NodeKind::Text { value, .. } if field.name.text == "file" => files.push(value.clone()),
                    _ => collect_files(&field.value, files),
                }
            }
        }
        NodeKind::Tuple(entries) | NodeKind::List(entries) => {
            entries.iter().for_each(|entry| collect_files(entry, files));
        }
        NodeKind::Map(entries) => entries.iter().for_each(|(_, value)| collect_files(value, files)),
        NodeKind::Bare | NodeKind::Text { .. } | NodeKind::Character(_) | NodeKind::Number { .. } => {}
    }
}
