//! `meshless resume`: continues a run from a checkpoint.

use std::path::{Path, PathBuf};

use clap::Args;
use meshless_engine::notation::quantity;
use meshless_engine::plugin::Registry;
use meshless_engine::record::Existing;
use meshless_engine::record::OutputOptions;
use meshless_engine::scene::{self, Scene, SceneError, Source};
use meshless_engine::simulation::Checkpoint;

use super::execution::{Execution, How, carry_out_together};
use super::failure::CommandFailure;
use super::folder;
use super::scene_file::replacement;
use super::text::complain;
use super::values::time;

/// Resume a run from a checkpoint
#[derive(Args)]
pub struct ResumeArguments {
    /// Checkpoint, or an output folder whose newest checkpoint is meant
    #[arg(value_name = "CHECKPOINT")]
    path: PathBuf,
    /// Run to this time [s] instead of the end time of the scene
    #[arg(long, value_name = "TIME", value_parser = time, allow_negative_numbers = true)]
    until: Option<f64>,
    /// Present path of the scene file, relative to which the files that it names are found; the scene itself
    /// is the one in the checkpoint
    #[arg(long, value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Replace a value of the scene from here on, as in `record.every=0.001`; may be given several times
    #[arg(long = "set", value_name = "PATH=VALUE", value_parser = replacement)]
    set: Vec<(String, String)>,
    #[command(flatten)]
    how: How,
}

/// Continues from the checkpoint, in its folder.
pub fn execute(arguments: ResumeArguments, registry: &Registry) -> Result<(), CommandFailure> {
    let how = arguments.how.clone();
    carry_out_together(&how, || prepared(arguments, registry))
}

/// The run as it was at the checkpoint.
fn prepared(arguments: ResumeArguments, registry: &Registry) -> Result<Execution, CommandFailure> {
    let ResumeArguments { path, until, scene: moved, set, .. } = arguments;
    let file = folder::checkpoint(&path)?;
    let checkpoint = Checkpoint::read(&file).map_err(|error| CommandFailure::Run(error.to_string()))?;
    let mut source = checkpoint.source();
    if let Some(scene) = moved {
        source.name = at_new_place(&scene)?;
    }
    for (path, value) in &set {
        source = source.with_override(path, value).map_err(|problem| source.error(vec![problem]))?;
    }
    let (mut scene, mut source) = scene::parse(source)?;
    let reached = checkpoint.clock().time;
    if let Some(end) = until {
        if end <= reached {
            let (reached, end) = (quantity(reached, "s"), quantity(end, "s"));
            return Err(CommandFailure::Usage(format!(
                "`--until` must be later than the {reached} of the checkpoint, found {end}"
            )));
        }
        (scene, source) = prolonged(&scene, &source, end)?;
    }
    if reached >= scene.time.end {
        let (reached, end) = (quantity(reached, "s"), quantity(scene.time.end, "s"));
        return Err(CommandFailure::Usage(format!(
            "the run is complete: the checkpoint is at {reached}, the scene ends at {end}; extend it with `--until TIME`"
        )));
    }
    let scene_file = Path::new(&source.name);
    for warning in checkpoint.scene_warning(scene_file).into_iter().chain(checkpoint.path_warning()) {
        complain(&format!("warning: {warning}"));
    }
    let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
    let output = OutputOptions { folder, existing: Existing::Replace, resume: true };
    let mut execution = Execution::new(&scene, &source, registry, output)?;
    execution.sim.restore(&checkpoint).map_err(|error| CommandFailure::Run(error.to_string()))?;
    Ok(execution)
}

/// The path of a scene file given by the user, which must exist.
fn at_new_place(scene: &Path) -> Result<String, CommandFailure> {
    if !scene.is_file() {
        return Err(CommandFailure::Usage(format!("the scene file `{}` does not exist", scene.display())));
    }
    Ok(std::path::absolute(scene).unwrap_or_else(|_| scene.to_path_buf()).display().to_string())
}

/// The scene with another end time. The interval of recording that follows from the end time keeps its value.
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
