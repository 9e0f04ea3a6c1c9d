//! The output folder of a run: its default, and what is in it.

use std::path::{Path, PathBuf};

use super::failure::Failure;

/// Name of the checkpoint that a run leaves when it stops before its end.
pub const CHECKPOINT: &str = "checkpoint.mlc";
/// Name of the state that a failed run leaves.
pub const FAILED: &str = "failed.mlc";

/// The folder of a scene's output where none is given: `out/<scene file without extension>`.
pub fn default_folder(scene: &Path) -> PathBuf {
    let stem = scene.file_stem().unwrap_or(scene.as_os_str());
    Path::new("out").join(stem)
}

/// The file itself, or the file in the folder that has this extension and was written last.
pub fn newest(path: &Path, extension: &str, what: &str) -> Result<PathBuf, Failure> {
    if path.is_file() {
        return Ok(path.to_path_buf());
    }
    let entries = std::fs::read_dir(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Failure::Usage(format!("`{}` does not exist", path.display())),
        _ => Failure::Run(format!("`{}` cannot be read: {error}", path.display())),
    })?;
    let mut found: Vec<_> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|file| file.extension().is_some_and(|other| other == extension))
        .filter(|file| !file.ends_with(FAILED))
        .filter_map(|file| Some((file.metadata().and_then(|data| data.modified()).ok()?, file)))
        .collect();
    found.sort();
    let newest = found.pop().map(|(_, file)| file);
    newest.ok_or_else(|| {
        Failure::Usage(format!("the folder `{}` holds no {what} (`*.{extension}`)", path.display()))
    })
}
