//! Inputs of a checkpoint beside the text of the scene: the files that it names, and its folder.

use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3;

use crate::scene::Source;

/// Inputs of a run beside the text of its scene.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Inputs {
    /// Path of the scene from the folder of the checkpoint.
    scene_from_here: Option<String>,
    /// Values of the parameters, by name.
    parameters: Vec<(String, f64)>,
    files: Vec<InputFile>,
    /// The file of the scene as it was when the run began; none where the scene did not come from a file.
    scene_file: Option<InputFile>,
}

/// A file that the scene names, as it was when the run began.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct InputFile {
    name: String,
    length: u64,
    hash: u128,
}

impl InputFile {
    /// The present content of the file at `path`, under that name.
    fn read(path: &Path, name: String) -> Option<Self> {
        let (length, hash) = fingerprint(path)?;
        Some(Self { name, length, hash })
    }
}

impl Inputs {
    /// The files of the scene as they are now. Those that cannot be read are left out: the scene cannot be
    /// built without them.
    pub fn of(source: &Source, parameters: impl IntoIterator<Item = (String, f64)>) -> Self {
        let file = |name: String| InputFile::read(&source.folder().join(&name), name);
        let files = source.files().into_iter().filter_map(file).collect();
        let scene_file = InputFile::read(Path::new(&source.name), String::new());
        Self { scene_from_here: None, parameters: parameters.into_iter().collect(), files, scene_file }
    }

    /// The same in a checkpoint `file` of the scene `scene`.
    pub fn beside(&self, file: &Path, scene: &str) -> Self {
        let from = std::path::absolute(file).ok();
        let to = std::path::absolute(scene).ok();
        let path = from.as_deref().and_then(Path::parent).zip(to).and_then(|(from, to)| relative(from, &to));
        Self { scene_from_here: path.map(|path| path.display().to_string()), ..self.clone() }
    }

    /// Where the scene lies, seen from a checkpoint in `folder`: there are projects that are moved as a
    /// whole.
    pub fn scene_in(&self, folder: &Path) -> Option<PathBuf> {
        let path = folder.join(self.scene_from_here.as_ref()?);
        path.is_file().then_some(path)
    }

    /// Whether the file at `path` is not the scene file that the run began with.
    pub fn is_another_scene(&self, path: &Path) -> bool {
        let now = InputFile::read(path, String::new());
        now.is_some() && self.scene_file.is_some() && now != self.scene_file
    }

    /// Keeps the scene file of the beginning of the run, which is that of `saved`.
    pub fn begin_like(&mut self, saved: &Self) {
        self.scene_file.clone_from(&saved.scene_file);
    }

    /// The first file that differs from its state in `saved`.
    pub fn changed_since<'s>(&self, saved: &'s Self) -> Option<&'s str> {
        let differs = |old: &&InputFile| self.files.iter().any(|new| new.name == old.name && new != *old);
        saved.files.iter().find(differs).map(|file| file.name.as_str())
    }
}

/// Length and XXH3 of a regular file, read in blocks.
fn fingerprint(path: &Path) -> Option<(u64, u128)> {
    if !path.is_file() {
        return None;
    }
    let mut file = std::fs::File::open(path).ok()?;
    let mut digest = Digest { hasher: Xxh3::new(), length: 0 };
    std::io::copy(&mut file, &mut digest).ok()?;
    Some((digest.length, digest.hasher.digest128()))
}

struct Digest {
    hasher: Xxh3,
    length: u64,
}

impl std::io::Write for Digest {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.hasher.update(bytes);
        self.length += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// The way from the folder `from` to `to`, both absolute.
fn relative(from: &Path, to: &Path) -> Option<PathBuf> {
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (from.components().collect(), to.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    // Different drives have no way between them.
    (common > 0).then(|| {
        let up = from[common..].iter().map(|_| Component::ParentDir);
        up.chain(to[common..].iter().copied()).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_between_folders() {
        let way =
            |from: &str, to: &str| relative(Path::new(from), Path::new(to)).unwrap().display().to_string();
        assert_eq!(way("/a/out/run", "/a/scene.ron"), "../../scene.ron");
        assert_eq!(way("/a", "/a/b/scene.ron"), "b/scene.ron");
        assert_eq!(way("/out", "/a/scene.ron"), "../a/scene.ron");
    }
}
