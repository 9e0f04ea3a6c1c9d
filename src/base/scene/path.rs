//! Values of a scene by path: `bodies[1].shape.min`, `bodies.plate.plugins.hourglass_control.alpha`.
//!
//! A step is the name of a field, the key of a map, or an index in brackets. In a list a step by name finds
//! the entry whose field `name` has that text, or the entry that has that name itself, as plugins and
//! conditions do; a number there is an index.

use std::ops::Range;

use super::tree::{Node, NodeKind, StructField};

/// One step of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PathStep {
    Name(String),
    Index(usize),
}

/// The steps of a path; none if the text is not a path.
pub(super) fn steps(path: &str) -> Option<Vec<PathStep>> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let (name, indices) = part.split_at(part.find('[').unwrap_or(part.len()));
        if !name.is_empty() {
            steps.push(PathStep::Name(name.trim().to_owned()));
        } else if indices.is_empty() {
            return None;
        }
        for index in indices.split_terminator(']') {
            steps.push(PathStep::Index(index.strip_prefix('[')?.trim().parse().ok()?));
        }
    }
    Some(steps)
}

/// Result of one step from a value.
pub(super) enum PathEnd<'a> {
    /// A field and its value.
    Field(&'a StructField),
    /// An entry of a tuple, list or map.
    Entry(&'a Node),
}

impl<'a> PathEnd<'a> {
    pub fn value(&self) -> &'a Node {
        match self {
            PathEnd::Field(field) => &field.value,
            PathEnd::Entry(node) => node,
        }
    }
}

/// Result of `step` from `node`.
pub(super) fn child<'a>(node: &'a Node, step: &PathStep) -> Option<PathEnd<'a>> {
    match (&node.kind, step) {
        (NodeKind::Fields(_), PathStep::Name(name)) => node.field(name).map(PathEnd::Field),
        (NodeKind::Map(entries), PathStep::Name(name)) => {
            entries.iter().find(|(key, _)| text(key) == Some(name)).map(|(_, value)| PathEnd::Entry(value))
        }
        (NodeKind::Map(entries), PathStep::Index(index)) => {
            entries.get(*index).map(|(_, value)| PathEnd::Entry(value))
        }
        (NodeKind::List(entries) | NodeKind::Tuple(entries), PathStep::Index(index)) => {
            entries.get(*index).map(PathEnd::Entry)
        }
        (NodeKind::List(entries), PathStep::Name(name)) => {
            let by_place = || name.parse().ok().and_then(|place: usize| entries.get(place));
            entries.iter().find(|entry| label(entry) == Some(name)).or_else(by_place).map(PathEnd::Entry)
        }
        (NodeKind::Tuple(entries), PathStep::Name(name)) if (2..=3).contains(&entries.len()) => {
            let axis = ["x", "y", "z"].iter().position(|axis| axis == name)?;
            entries.get(axis).map(PathEnd::Entry)
        }
        // `Some(value)` and a variant with a single value are passed over: the step goes to their content.
        (NodeKind::Tuple(entries), PathStep::Name(_)) if entries.len() == 1 => child(&entries[0], step),
        _ => None,
    }
}

/// The names that a step from `node` may have.
pub(super) fn children(node: &Node) -> Vec<&str> {
    match &node.kind {
        NodeKind::Fields(fields) => fields.iter().map(|field| field.name.text.as_str()).collect(),
        NodeKind::Map(entries) => entries.iter().filter_map(|(key, _)| text(key)).collect(),
        NodeKind::List(entries) => entries.iter().filter_map(label).collect(),
        _ => Vec::new(),
    }
}

/// The bytes of the value at `path`, or of its nearest parent in the text.
pub(super) fn nearest(root: &Node, path: &str) -> Range<usize> {
    let mut node = root;
    for step in steps(path).unwrap_or_default() {
        match child(node, &step) {
            Some(found) => node = found.value(),
            None => return node.head(),
        }
    }
    if node.span == root.span { node.head() } else { node.span.clone() }
}

/// The bytes of the value at `path`, if it exists.
pub(super) fn exact(root: &Node, path: &str) -> Option<Range<usize>> {
    let found = steps(path)?.iter().try_fold(root, |node, step| Some(child(node, step)?.value()))?;
    Some(found.span.clone())
}

/// The name under which an entry of a list is found.
fn label(entry: &Node) -> Option<&str> {
    match entry.field("name") {
        Some(field) => text(&field.value),
        None => entry.name.as_ref().map(|name| name.text.as_str()),
    }
}

fn text(node: &Node) -> Option<&str> {
    match &node.kind {
        NodeKind::Text { value, .. } => Some(value),
        _ => None,
    }
}
