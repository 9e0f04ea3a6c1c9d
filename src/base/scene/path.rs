//! Places in a scene by path: `bodies[1].shape.min`, `bodies.plate.plugins.hourglass_control.alpha`.
//!
//! A step is the name of a field, the key of a map, or an index in brackets. In a list a step by name finds the entry
//! whose field `name` is that text, or the entry that is itself called so, as plugins and conditions are; a number there is an index.

use std::ops::Range;

use super::tree::{Field, Kind, Node};

/// One step of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Step {
    Name(String),
    Index(usize),
}

/// The steps of a path; none where it is not a path.
pub(super) fn steps(path: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let (name, indices) = part.split_at(part.find('[').unwrap_or(part.len()));
        if !name.is_empty() {
            steps.push(Step::Name(name.trim().to_owned()));
        } else if indices.is_empty() {
            return None;
        }
        for index in indices.split_terminator(']') {
            steps.push(Step::Index(index.strip_prefix('[')?.trim().parse().ok()?));
        }
    }
    Some(steps)
}

/// What one step from a value leads to.
pub(super) enum Found<'a> {
    /// A field and its value.
    Field(&'a Field),
    /// An entry of a tuple, list or map.
    Entry(&'a Node),
}

impl<'a> Found<'a> {
    pub fn value(&self) -> &'a Node {
        match self {
            Found::Field(field) => &field.value,
            Found::Entry(node) => node,
        }
    }
}

/// What `step` leads to from `node`.
pub(super) fn child<'a>(node: &'a Node, step: &Step) -> Option<Found<'a>> {
    match (&node.kind, step) {
        (Kind::Fields(_), Step::Name(name)) => node.field(name).map(Found::Field),
        (Kind::Map(entries), Step::Name(name)) => {
            entries.iter().find(|(key, _)| text(key) == Some(name)).map(|(_, value)| Found::Entry(value))
        }
        (Kind::Map(entries), Step::Index(index)) => entries.get(*index).map(|(_, value)| Found::Entry(value)),
        (Kind::List(entries) | Kind::Tuple(entries), Step::Index(index)) => {
            entries.get(*index).map(Found::Entry)
        }
        (Kind::List(entries), Step::Name(name)) => {
            let by_place = || name.parse().ok().and_then(|place: usize| entries.get(place));
            entries.iter().find(|entry| label(entry) == Some(name)).or_else(by_place).map(Found::Entry)
        }
        (Kind::Tuple(entries), Step::Name(name)) if (2..=3).contains(&entries.len()) => {
            let axis = ["x", "y", "z"].iter().position(|axis| axis == name)?;
            entries.get(axis).map(Found::Entry)
        }
        // `Some(value)` and a variant around one struct are what they hold.
        (Kind::Tuple(entries), Step::Name(_)) if entries.len() == 1 => child(&entries[0], step),
        _ => None,
    }
}

/// The names that a step from `node` may have.
pub(super) fn children(node: &Node) -> Vec<&str> {
    match &node.kind {
        Kind::Fields(fields) => fields.iter().map(|field| field.name.text.as_str()).collect(),
        Kind::Map(entries) => entries.iter().filter_map(|(key, _)| text(key)).collect(),
        Kind::List(entries) => entries.iter().filter_map(label).collect(),
        _ => Vec::new(),
    }
}

/// The bytes of the value at `path`, or of the nearest value above it that is there.
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

/// The bytes of the value at `path`, if it is there.
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
        Kind::Text { value, .. } => Some(value),
        _ => None,
    }
}
