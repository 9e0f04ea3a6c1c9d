//! A scene text as a tree of values with their positions in the text.

use std::ops::Range;

/// A name in the text: of a field, a struct or a variant.
#[derive(Clone, Debug)]
pub(super) struct Word {
    pub text: String,
    pub span: Range<usize>,
}

/// A value in the text.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// All bytes of the value, its name and brackets included.
    pub span: Range<usize>,
    /// The name before the brackets, or the whole of a bare word.
    pub name: Option<Word>,
    /// The byte after the opening bracket; the start of the value where it has none.
    pub open: usize,
    pub kind: NodeKind,
}

/// Kind and content of a value.
#[derive(Clone, Debug)]
pub(super) enum NodeKind {
    /// A word without brackets: `None`, `true`, `Eulerian`.
    Bare,
    /// `(a: 1, b: 2)`.
    Fields(Vec<StructField>),
    /// `(1, 2)`, and also `()`.
    Tuple(Vec<Node>),
    List(Vec<Node>),
    Map(Vec<(Node, Node)>),
    /// `content` is the position of the first character between the quotes; it is `None` if escapes shift the
    /// positions.
    Text {
        value: String,
        content: Option<usize>,
    },
    Character(char),
    Number {
        value: f64,
        integer: Option<i128>,
    },
}

/// A field of a struct.
#[derive(Clone, Debug)]
pub(super) struct StructField {
    pub name: Word,
    pub value: Node,
}

impl Node {
    /// The part that stands for the value in a message: its name, or its opening bracket, or all of a simple
    /// value.
    pub fn head(&self) -> Range<usize> {
        match (&self.name, &self.kind) {
            (Some(name), _) => name.span.clone(),
            (None, NodeKind::Fields(_) | NodeKind::Tuple(_) | NodeKind::List(_) | NodeKind::Map(_)) => {
                self.span.start..self.span.start + 1
            }
            _ => self.span.clone(),
        }
    }

    /// The fields; empty for values without fields, such as `()` or a bare word.
    pub fn fields(&self) -> &[StructField] {
        match &self.kind {
            NodeKind::Fields(fields) => fields,
            _ => &[],
        }
    }

    /// The value of a field.
    pub fn field(&self, name: &str) -> Option<&StructField> {
        self.fields().iter().find(|field| field.name.text == name)
    }

    /// Whether this is the bare word `word`.
    pub fn is_bare(&self, word: &str) -> bool {
        matches!(self.kind, NodeKind::Bare) && self.name.as_ref().is_some_and(|name| name.text == word)
    }

    /// Description of the value for messages.
    pub fn describe(&self) -> String {
        let name = self.name.as_ref().map(|name| name.text.as_str());
        match &self.kind {
            NodeKind::Bare => format!("`{}`", name.unwrap_or_default()),
            NodeKind::Fields(_) | NodeKind::Tuple(_) if name.is_some() => {
                format!("`{}(...)`", name.unwrap_or_default())
            }
            NodeKind::Fields(_) => "a struct `(name: ...)`".into(),
            NodeKind::Tuple(entries) => match entries.len() {
                0 => "`()`".into(),
                1 => "a tuple of 1 entry".into(),
                n => format!("a tuple of {n} entries"),
            },
            NodeKind::List(_) => "a list `[...]`".into(),
            NodeKind::Map(_) => "a map `{...}`".into(),
            NodeKind::Text { value, .. } => format!("the text {value:?}"),
            NodeKind::Character(value) => format!("the character {value:?}"),
            NodeKind::Number { value, integer: None } => format!("the number {value:?}"),
            NodeKind::Number { integer: Some(integer), .. } => format!("the number {integer}"),
        }
    }
}
