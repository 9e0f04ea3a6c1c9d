//! Single values of a scene replaced from outside: `time.end=0.5`, `bodies.plate.plugins.hourglass_control.alpha=10`.

use super::names::nearest;
use super::path::{self, Step};
use super::tree::{Kind, Node};
use super::{Problem, Source, syntax};

/// Blocks of a scene that may be left out as a whole and are begun when a field of theirs is set.
const OPTIONAL_BLOCKS: [&str; 2] = ["domain", "record"];

impl Source {
    /// The text with the value at `path` replaced by `value`, or added where the struct around it lacks the field.
    /// Lines stay where they are. The value of a text may be given without quotes.
    ///
    /// # Errors
    /// The text or `value` is not RON, or `path` leads nowhere.
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
                None => {
                    let (at, text) = insertion(node, &steps[i..], &written(&value, None, &setting)?)
                        .ok_or_else(|| not_there(node, step, &setting))?;
                    return Ok(self.edited(at..at, &text));
                }
            }
        }
        Ok(self.edited(node.span.clone(), &written(&value, Some(node), &setting)?))
    }

    fn edited(&self, range: std::ops::Range<usize>, with: &str) -> Self {
        let mut text = self.text.clone();
        text.replace_range(range, with);
        Self::new(self.name.clone(), text)
    }
}

/// The value as the scene has to say it: a text that replaces a text may lack its quotes.
fn written(value: &str, replaced: Option<&Node>, setting: &str) -> Result<String, Problem> {
    let parsed = syntax::read(value, 0);
    let replaces_text = replaced.is_some_and(|node| matches!(node.kind, Kind::Text { .. }));
    match parsed {
        Ok(Node { kind: Kind::Text { .. } | Kind::Number { .. }, .. }) => Ok(value.to_owned()),
        _ if replaces_text => Ok(format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\""))),
        Ok(_) => Ok(value.to_owned()),
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

/// Where the rest of a path is to be added, and the text.
fn insertion(node: &Node, rest: &[Step], value: &str) -> Option<(usize, String)> {
    let text = match rest {
        [Step::Name(name)] => match node.kind {
            Kind::Map(_) => format!("{name:?}: {value}"),
            _ => format!("{name}: {value}"),
        },
        [Step::Name(block), Step::Name(name)] if OPTIONAL_BLOCKS.contains(&block.as_str()) => {
            format!("{block}: ({name}: {value})")
        }
        _ => return None,
    };
    match &node.kind {
        Kind::Fields(_) => Some((node.open, format!("{text}, "))),
        Kind::Map(entries) if entries.is_empty() => Some((node.open, text)),
        Kind::Map(_) => Some((node.open, format!("{text}, "))),
        Kind::Tuple(entries) if entries.is_empty() => Some((node.open, text)),
        Kind::Bare if !["None", "true", "false"].iter().any(|word| node.is_bare(word)) => {
            Some((node.span.end, format!("({text})")))
        }
        _ => None,
    }
}

fn not_there(node: &Node, step: &Step, setting: &str) -> Problem {
    let children = path::children(node);
    match step {
        Step::Name(name) => {
            let problem = Problem::at_span(node.head(), format!("`{setting}`: there is no `{name}` here"));
            let problem = match nearest(name, &children) {
                Some(near) => problem.help(format!("did you mean `{near}`?")),
                None => problem,
            };
            if children.is_empty() {
                problem
            } else {
                problem.help(format!("here are: {}", children.join(", ")))
            }
        }
        Step::Index(index) => {
            let count = match &node.kind {
                Kind::List(entries) | Kind::Tuple(entries) => entries.len(),
                Kind::Map(entries) => entries.len(),
                _ => 0,
            };
            Problem::at_span(node.head(), format!("`{setting}`: there is no entry {index} here"))
                .help(format!("there are {count} entries, counted from 0"))
        }
    }
}

/// A name that several entries of a list share cannot say which is meant.
fn unambiguous(node: &Node, step: &Step, setting: &str) -> Result<(), Problem> {
    if let (Kind::List(_), Step::Name(name)) = (&node.kind, step) {
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
