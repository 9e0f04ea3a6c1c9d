//! Overrides, single values of a scene replaced from outside: `time.end=0.5`,
//! `bodies.plate.plugins.hourglass_control.alpha=10`.

use super::expression::{constant, words};
use super::names::nearest;
use super::path::{self, PathStep};
use super::symbols::Symbols;
use super::tree::{Node, NodeKind};
use super::{Problem, Source, syntax};

/// Optional blocks of a scene; an override of one of their fields adds the block.
const OPTIONAL_BLOCKS: [&str; 2] = ["domain", "record"];

impl Source {
    /// The text with the value at `path` replaced by `value`, or added if the enclosing struct lacks the
    /// field. Line numbers stay the same. The quotes of a text value may be omitted.
    ///
    /// # Errors
    /// The text or `value` is not RON, or `path` does not exist.
    pub fn with_override(&self, path: &str, value: &str) -> Result<Self, Problem> {
        let root = self.tree()?;
        let value = value.replace(['\n', '\r'], " ");
        let setting = format!("{path}={value}");
        let Some(steps) = path::steps(path) else {
            return Err(Problem::new(format!("`{setting}` does not start with the path of a value"))
                .help("paths look like time.end, bodies[0].spacing, bodies.plate.spacing"));
        };
        let mut node = &root;
        for (i, step) in steps.iter().enumerate() {
            match path::child(node, step) {
                Some(found) => {
                    unambiguous(node, step, &setting)?;
                    node = found.value();
                }
                // No expression of the scene can use a parameter that the scene does not define.
                None if i == 1 && steps[0] == PathStep::Name("parameters".into()) => {
                    return Err(not_there(node, step, &setting));
                }
                None => {
                    let (at, text) = insertion(node, &steps[i..], &written(&value, None, &setting)?)
                        .ok_or_else(|| not_there(node, step, &setting))?;
                    return Ok(self.edited(at..at, &text, path, &value));
                }
            }
        }
        let text = written(&value, Some(node), &setting)?;
        Ok(self.edited(node.span.clone(), &text, path, &value))
    }

    /// The text with `setting` at `range`.
    fn edited(&self, range: std::ops::Range<usize>, with: &str, path: &str, value: &str) -> Self {
        let mut changed = self.clone();
        changed.text.replace_range(range, with);
        changed.settings.push((path.to_owned(), value.to_owned()));
        changed
    }

    /// The last override that has written the text at `span`, as `path=value`.
    pub(super) fn setting_at(&self, span: &std::ops::Range<usize>) -> Option<String> {
        let root = self.tree().ok()?;
        let covers = |path: &str| {
            path::exact(&root, path).is_some_and(|range| range.start <= span.start && span.end <= range.end)
        };
        let setting = self.settings.iter().rev().find(|(path, _)| covers(path));
        setting.map(|(path, value)| format!("{path}={value}"))
    }
}

/// The value in the notation of the scene: a text that replaces a text gets its quotes.
fn written(value: &str, replaced: Option<&Node>, setting: &str) -> Result<String, Problem> {
    let parsed = syntax::read(value, 0);
    let replaces_number = replaced.is_some_and(|node| matches!(node.kind, NodeKind::Number { .. }));
    let replaces_text = replaced.is_some_and(|node| matches!(node.kind, NodeKind::Text { .. }));
    match parsed {
        Ok(Node { kind: NodeKind::Text { .. } | NodeKind::Number { .. }, .. }) => Ok(value.to_owned()),
        _ if replaces_text => Ok(format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\""))),
        Ok(_) => Ok(value.to_owned()),
        // `10*dx` is not RON, but in quotes it may stand for a number.
        Err(_) if replaces_number && is_expression(value) => Ok(format!("\"{value}\"")),
        Err(problem) => {
            let place =
                replaced.map(|node| Problem::at_span(node.head(), "")).unwrap_or_else(|| Problem::new(""));
            Err(Problem {
                message: format!("the value of `{setting}` cannot be read: {}", problem.message),
                ..place
            })
        }
    }
}

/// Whether a text has the syntax of an expression, with any names.
fn is_expression(text: &str) -> bool {
    let parameters = words(text).map(|word| (word.to_owned(), 1.0)).collect();
    constant(text, &Symbols { parameters, ..Symbols::default() }).is_ok()
}

/// The byte at which the rest of a path is inserted, and the inserted text.
fn insertion(node: &Node, rest: &[PathStep], value: &str) -> Option<(usize, String)> {
    let text = match rest {
        [PathStep::Name(name)] => match node.kind {
            NodeKind::Map(_) => format!("{name:?}: {value}"),
            _ => format!("{name}: {value}"),
        },
        [PathStep::Name(block), PathStep::Name(name)] if OPTIONAL_BLOCKS.contains(&block.as_str()) => {
            format!("{block}: ({name}: {value})")
        }
        _ => return None,
    };
    match &node.kind {
        NodeKind::Fields(_) => Some((node.open, format!("{text}, "))),
        NodeKind::Map(entries) if entries.is_empty() => Some((node.open, text)),
        NodeKind::Map(_) => Some((node.open, format!("{text}, "))),
        NodeKind::Tuple(entries) if entries.is_empty() => Some((node.open, text)),
        NodeKind::Bare if !["None", "true", "false"].iter().any(|word| node.is_bare(word)) => {
            Some((node.span.end, format!("({text})")))
        }
        _ => None,
    }
}

fn not_there(node: &Node, step: &PathStep, setting: &str) -> Problem {
    let children = path::children(node);
    match step {
        PathStep::Name(name) => {
            let problem = Problem::at_span(node.head(), format!("`{setting}`: there is no `{name}` here"));
            let problem = match nearest(name, &children) {
                Some(near) => problem.help(format!("did you mean `{near}`?")),
                None => problem,
            };
            if children.is_empty() {
                problem
            } else if let NodeKind::List(entries) = &node.kind {
                let last = entries.len().saturating_sub(1);
                problem.help(format!(
                    "here are: {}; entries can be counted too, from [0] to [{last}]",
                    children.join(", ")
                ))
            } else {
                problem.help(format!("here are: {}", children.join(", ")))
            }
        }
        PathStep::Index(index) => {
            let count = match &node.kind {
                NodeKind::List(entries) | NodeKind::Tuple(entries) => entries.len(),
                NodeKind::Map(entries) => entries.len(),
                _ => 0,
            };
            Problem::at_span(node.head(), format!("`{setting}`: there is no entry {index} here"))
                .help(format!("there are {count} entries, counted from 0"))
        }
    }
}

/// Rejects a name that several entries of a list share.
fn unambiguous(node: &Node, step: &PathStep, setting: &str) -> Result<(), Problem> {
    if let (NodeKind::List(_), PathStep::Name(name)) = (&node.kind, step) {
        let count = path::children(node).into_iter().filter(|child| child == name).count();
        if count > 1 {
            return Err(Problem::at_span(
                node.head(),
                format!("`{setting}`: {count} entries here are called `{name}`"),
            )
            .help("give the index instead, such as [0]"));
        }
    }
    Ok(())
}
