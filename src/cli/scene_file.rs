//! The scene argument of several commands: a file and overrides.

use std::io::Read;
use std::path::{Path, PathBuf};

use clap::Args;
use meshless_engine::assembly::name_problems;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{self, Problem, Scene, SceneError, Source};

/// Maximum size of a scene from the standard input, B.
const MAX_INPUT: u64 = 64 << 20;

/// A scene file, with replaced values.
#[derive(Args)]
pub struct SceneFile {
    /// Scene file; `-` reads it from the standard input
    #[arg(value_name = "SCENE")]
    pub path: PathBuf,
    /// Replace a value of the scene, as in `time.end=0.5` or `bodies.plate.spacing=0.01`; may be given
    /// several times
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
    /// The path after which the output folder is named.
    pub fn named(&self) -> &Path {
        if self.path == Path::new("-") { Path::new("stdin.ron") } else { &self.path }
    }

    /// Reads the scene and checks its names against the registry.
    pub fn load(&self, registry: &Registry) -> Result<(Scene, Source), SceneError> {
        let names = |scene: &Scene| name_problems(scene, registry);
        if self.path != Path::new("-") {
            return scene::load_checked(&self.path, &self.set, &names);
        }
        let mut text = String::new();
        let read = std::io::stdin().take(MAX_INPUT).read_to_string(&mut text);
        let source = Source::new("stdin.ron", text);
        if let Err(error) = read {
            return Err(
                source.error(vec![Problem::new(format!("the standard input cannot be read: {error}"))])
            );
        }
        scene::parse_checked(source, &self.set, &names)
    }
}
