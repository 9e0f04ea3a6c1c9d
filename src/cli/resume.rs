//! `meshless resume`: a run that goes on from a checkpoint.

use std::path::{Path, PathBuf};

use clap::Args;
use meshless_engine::plugin::Registry;
use meshless_engine::record::Existing;
use meshless_engine::record::OutputOptions;
use meshless_engine::scene::{self, Scene, SceneError, Source};
use meshless_engine::simulation::Checkpoint;

use super::execution::{Execution, How};
use super::failure::Failure;
use super::folder;
use super::text::complain;

/// Go on from a checkpoint
#[derive(Args)]
pub struct Arguments {
    /// Checkpoint, or an output folder whose newest checkpoint is meant
    #[arg(value_name = "CHECKPOINT")]
    path: PathBuf,
    /// Run to this time [s] instead of the end time of the scene
    #[arg(long, value_name = "TIME")]
    until: Option<f64>,
    #[command(flatten)]
    how: How,
}

/// Goes on from the checkpoint, in the folder it is in.
pub fn execute(arguments: Arguments, registry: &Registry) -> Result<(), Failure> {
    let Arguments { path, until, how } = arguments;
    // Before the checkpoint is read, which takes threads of its own.
    how.set_threads()?;
    let file = folder::checkpoint(&path)?;
    let checkpoint = Checkpoint::read(&file).map_err(|error| Failure::Run(error.to_string()))?;
    let (mut scene, mut source) = scene::parse(checkpoint.source())?;
    if let Some(end) = until {
        (scene, source) = prolonged(&scene, &source, end)?;
    }
    if checkpoint.clock().time >= scene.time.end {
        return Err(Failure::Usage(format!(
            "the checkpoint is at {:.6e} s, which is the end of the run; go further with `--until`",
            checkpoint.clock().time
        )));
    }
    if let Some(warning) = checkpoint.path_warning() {
        complain(&format!("warning: {warning}"));
    }
    let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
    let output = OutputOptions { folder, existing: Existing::Replace, resume: true };
    let mut execution = Execution::new(&scene, &source, registry, output)?;
    execution.sim.restore(&checkpoint).map_err(|error| Failure::Run(error.to_string()))?;
    execution.carry_out(&how)
}

/// The scene with another end time. What follows from the end time where the scene is silent stays as it was.
fn prolonged(scene: &Scene, source: &Source, end: f64) -> Result<(Scene, Source), SceneError> {
    let interval = format!("{:?}", scene.record_interval());
    let mut settings = vec![("time.end", format!("{end:?}"))];
    if scene.record.every.is_none() {
        settings.push(("record.every", interval));
    }
    let mut text = source.clone();
    for (path, value) in &settings {
        text = text.with_override(path, value).map_err(|problem| source.error(vec![problem]))?;
    }
    scene::parse(text)
}
