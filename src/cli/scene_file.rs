//! The scene argument that several commands share: a file and values that replace some of its own.

use std::path::PathBuf;

use clap::Args;
use meshless_engine::scene::{self, Scene, SceneError, Source};

/// A scene file, with replaced values.
#[derive(Args)]
pub struct SceneFile {
    /// Scene file
    #[arg(value_name = "SCENE")]
    pub path: PathBuf,
    /// Replace a value of the scene, as in `time.end=0.5` or `bodies.plate.spacing=0.01`; may be given several times
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = replacement)]
    pub set: Vec<(String, String)>,
}

/// Path and value of `path=value`.
pub fn replacement(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((path, value)) if !path.trim().is_empty() && !value.trim().is_empty() => {
            Ok((path.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("expected `path=value`, as in `time.end=0.5`".into()),
    }
}

impl SceneFile {
    /// Reads the scene.
    pub fn load(&self) -> Result<(Scene, Source), SceneError> {
        scene::load(&self.path, &self.set)
    }
}
