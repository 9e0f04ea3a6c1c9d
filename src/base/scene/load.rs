//! Reads a scene from a file or a text.

use std::path::Path;

use super::check::check;
use super::decode::{Decoded, decode};
use super::definitions::define;
use super::{Problem, Scene, SceneError, Source};
use crate::files;

/// Reads a scene file with overrides, pairs of path and value, as in `("time.end", "0.5")`.
///
/// # Errors
/// The file cannot be read, the path of an override does not exist, or the text is not a valid scene; all
/// problems are reported together.
pub fn load(path: &Path, overrides: &[(String, String)]) -> Result<(Scene, Source), SceneError> {
    load_checked(path, overrides, &|_| Vec::new())
}

/// [`load`] with a further check, such as one of names.
///
/// # Errors
/// Those of [`load`] and those that the check finds, all reported together.
pub fn load_checked(
    path: &Path,
    overrides: &[(String, String)],
    check_too: &dyn Fn(&Scene) -> Vec<Problem>,
) -> Result<(Scene, Source), SceneError> {
    let name = path.display().to_string();
    let read = files::read(path, files::MAX_TEXT).map_err(|error| {
        let source = Source::new(name.clone(), "");
        let problem = Problem::new(match error.kind() {
            std::io::ErrorKind::NotFound => "the scene file does not exist".into(),
            _ if path.is_dir() => "this is a folder, not a scene file".into(),
            _ => format!("the scene file cannot be read: {error}"),
        });
        source.error(vec![problem])
    })?;
    let text = String::from_utf8(read).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..byte].iter().filter(|&&byte| byte == b'\n').count();
        let problem =
            Problem::new(format!("the scene file is not UTF-8 text: line {line} has an invalid byte"));
        Source::new(name.clone(), "").error(vec![problem])
    })?;
    parse_checked(Source::new(name, text), overrides, check_too)
}

/// Reads a scene text with overrides as in [`load`].
///
/// # Errors
/// The path of an override does not exist, or the text is not a valid scene; all problems are reported
/// together.
pub fn parse_with(source: Source, overrides: &[(String, String)]) -> Result<(Scene, Source), SceneError> {
    parse_checked(source, overrides, &|_| Vec::new())
}

/// Reads a scene text.
///
/// # Errors
/// The text is not a valid scene; all problems are reported together.
pub fn parse(source: Source) -> Result<(Scene, Source), SceneError> {
    parse_with(source, &[])
}

/// [`parse_with`] with a further check, such as one of names.
///
/// # Errors
/// Those of [`parse_with`] and those that the check finds, all reported together.
pub fn parse_checked(
    mut source: Source,
    overrides: &[(String, String)],
    check_too: &dyn Fn(&Scene) -> Vec<Problem>,
) -> Result<(Scene, Source), SceneError> {
    for (path, value) in overrides {
        source = source.with_override(path, value).map_err(|problem| source.error(vec![problem]))?;
    }
    let root = source.tree().map_err(|problem| source.error(vec![problem]))?;
    let symbols = define(&root, &source.text, source.folder()).map_err(|problems| source.error(problems))?;
    let Decoded { value, mut problems } = decode::<Scene>(&root, &source.text, 0, false, &symbols);
    if let Some(scene) = &value {
        problems.extend(check(scene));
        problems.extend(check_too(scene));
    }
    problems.sort_by_key(|problem| problem.span(&source).map_or(0, |span| span.start));
    match value {
        Some(scene) if problems.is_empty() => Ok((scene, source)),
        _ => Err(source.error(problems)),
    }
}

impl Scene {
    /// The scene as RON text that [`parse`] reads back. Checkpoints store it, and the errors of a scene that
    /// a program assembles refer to it.
    ///
    /// # Errors
    /// A value has no RON form.
    pub fn to_source(&self, name: &str) -> Result<Source, ron::Error> {
        let style = ron::ser::PrettyConfig::new()
            .struct_names(true)
            .extensions(ron::extensions::Extensions::empty())
            .compact_arrays(true);
        Ok(Source::new(name, ron::ser::to_string_pretty(self, style)?))
    }
}
