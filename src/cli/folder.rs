//! The output folder of a run: its default, and its content.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::failure::CommandFailure;

/// Name of the checkpoint of a run.
pub const CHECKPOINT: &str = "checkpoint.mlc";
/// Name of the saved state of a failed run.
pub const FAILED: &str = "failed.mlc";

/// First bytes of a recording.
const SIGNATURE: &[u8; 4] = b"RRF2";

/// The folder of a scene's output where none is given: `out/<scene file without extension>`.
pub fn default_folder(scene: &Path) -> PathBuf {
    let stem = scene.file_stem().unwrap_or(scene.as_os_str());
    Path::new("out").join(stem)
}

/// The path of a checkpoint, given directly or by its folder.
pub fn checkpoint(path: &Path) -> Result<PathBuf, CommandFailure> {
    let file = if path.is_dir() { path.join(CHECKPOINT) } else { path.to_path_buf() };
    if file.is_file() {
        return Ok(file);
    }
    Err(CommandFailure::Usage(format!(
        "there is no checkpoint `{}`; a run leaves one when it ends or is stopped, unless it has failed or the \
         scene says `record: (checkpoint_at_end: false)`",
        file.display()
    )))
}

/// The path of a recording, given directly or as the newest in its folder.
pub fn recording(path: &Path) -> Result<PathBuf, CommandFailure> {
    if path.is_file() {
        return match is_recording(path) {
            true => Ok(path.to_path_buf()),
            false => Err(CommandFailure::Usage(format!("`{}` is not a recording (`*.rrd`)", path.display()))),
        };
    }
    let mut found: Vec<_> = files(path)?
        .into_iter()
        .filter(|file| file.extension().is_some_and(|extension| extension == "rrd"))
        .filter_map(|file| Some((file.metadata().and_then(|data| data.modified()).ok()?, file)))
        .collect();
    found.sort();
    let newest = found.pop().map(|(_, file)| file);
    newest.ok_or_else(|| {
        CommandFailure::Usage(format!(
            "the folder `{}` contains no recording (`*.rrd`); the plugin `rerun_recorder` writes one",
            path.display()
        ))
    })
}

/// Whether the file begins as recordings do.
fn is_recording(file: &Path) -> bool {
    let mut begin = [0; SIGNATURE.len()];
    File::open(file).and_then(|mut file| file.read_exact(&mut begin)).is_ok() && begin == *SIGNATURE
}

/// The files of a folder, in the order of their names.
pub fn files(folder: &Path) -> Result<Vec<PathBuf>, CommandFailure> {
    let entries = std::fs::read_dir(folder).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            CommandFailure::Usage(format!("`{}` does not exist", folder.display()))
        }
        _ => CommandFailure::Run(format!("`{}` cannot be read: {error}", folder.display())),
    })?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| file.is_file());
    files.sort();
    Ok(files)
}
