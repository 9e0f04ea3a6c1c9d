//! A problem of a scene: its description, position and correction.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};

use super::Source;
use super::path;

/// One problem of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The description, lower case, without a full stop.
    pub message: String,
    /// The position.
    pub at: SourcePlace,
    /// The corrections, a line each.
    pub help: Vec<String>,
}

/// A position in a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SourcePlace {
    /// The scene as a whole.
    Scene,
    /// Bytes of the text.
    Span(Range<usize>),
    /// A value by its path, such as `bodies[1].shape.min` or `bodies.plate.spacing`; if the text does not
    /// contain it, its nearest parent in the text.
    Path(String),
}

impl Problem {
    /// A problem of the scene as a whole.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), at: SourcePlace::Scene, help: Vec::new() }
    }

    /// A problem at bytes of the text.
    pub fn at_span(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { at: SourcePlace::Span(span), ..Self::new(message) }
    }

    /// A problem at a value by its path, such as `bodies[1].spacing`.
    pub fn at_path(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self { at: SourcePlace::Path(path.into()), ..Self::new(message) }
    }

    /// The same problem with a line that states the correction.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.extend(Some(help.into()).filter(|help| !help.is_empty()));
        self
    }

    /// The same problem with several lines that state the correction.
    #[must_use]
    pub fn helps(mut self, helps: impl IntoIterator<Item = String>) -> Self {
        self.help.extend(helps);
        self
    }

    /// The bytes of `source` that the problem refers to; none for the scene as a whole.
    pub fn span(&self, source: &Source) -> Option<Range<usize>> {
        match &self.at {
            SourcePlace::Scene => None,
            SourcePlace::Span(span) => Some(span.clone()),
            SourcePlace::Path(path) => source.tree().ok().map(|tree| path::nearest(&tree, path)),
        }
    }

    /// The problem as text: message, file, line, column, the line with carets, help.
    pub fn render(&self, source: &Source) -> String {
        self.rendered(source, &Renderer::plain())
    }

    fn rendered(&self, source: &Source, renderer: &Renderer) -> String {
        let title = Level::ERROR.primary_title(&self.message);
        let group = match self.span(source) {
            Some(span) => title.element(
                Snippet::source(source.text.as_str())
                    .path(source.name.as_str())
                    .annotation(AnnotationKind::Primary.span(first_line(&source.text, span))),
            ),
            None => title.element(Origin::path(source.name.as_str())),
        };
        let setting = self.span(source).and_then(|span| source.setting_at(&span));
        let setting = setting.map(|setting| format!("this value was given by `--set {setting}`"));
        let group = group.elements(setting.iter().map(|note| Level::NOTE.message(note)));
        let group = group.elements(self.help.iter().map(|help| Level::HELP.message(help)));
        renderer.render(&[group])
    }
}

/// The part of a span on its first line, at character boundaries.
fn first_line(text: &str, span: Range<usize>) -> Range<usize> {
    let boundary = |mut at: usize| {
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let start = boundary(span.start.min(text.len()));
    let end = boundary(span.end.clamp(start, text.len()));
    start..text[start..end].find('\n').map_or(end, |newline| start + newline)
}

/// A scene that cannot be used, with all its problems.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// The text that the problems refer to.
    pub source: Source,
    /// The problems, in the order of the text.
    pub problems: Vec<Problem>,
}

impl SceneError {
    /// All problems as text with colours, for a terminal.
    pub fn styled(&self) -> String {
        let renderer = Renderer::styled();
        let problems = self.problems.iter().map(|problem| problem.rendered(&self.source, &renderer));
        problems.collect::<Vec<_>>().join("\n\n")
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.problems.iter().enumerate() {
            if i > 0 {
                f.write_str("\n\n")?;
            }
            f.write_str(&problem.render(&self.source))?;
        }
        Ok(())
    }
}

impl std::error::Error for SceneError {}
