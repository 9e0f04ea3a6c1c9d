//! `meshless run`: a scene from its start to its end.

use std::path::PathBuf;

use clap::Args;
use meshless_engine::plugin::Registry;
use meshless_engine::ranks;
use meshless_engine::record::Existing;
use meshless_engine::record::OutputOptions;

use super::execution::{Execution, How, carry_out_together};
use super::failure::CommandFailure;
use super::folder::{FAILED, default_folder};
use super::scene_file::SceneFile;

/// Run a scene
#[derive(Args)]
pub struct RunArguments {
    #[command(flatten)]
    scene: SceneFile,
    /// Folder to write to [default: out/<scene>]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Overwrite the output of an earlier run
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    how: How,
}

/// Runs the scene.
pub fn execute(arguments: RunArguments, registry: &Registry) -> Result<(), CommandFailure> {
    let how = arguments.how.clone();
    carry_out_together(&how, || prepared(arguments, registry))
}

fn prepared(arguments: RunArguments, registry: &Registry) -> Result<Execution, CommandFailure> {
    let RunArguments { scene: file, out, force, .. } = arguments;
    let (scene, source) = file.load(registry)?;
    let folder = out.unwrap_or_else(|| default_folder(file.named()));
    let failed = folder.join(FAILED);
    let existing = if force { Existing::Replace } else { Existing::Refuse };
    let execution =
        Execution::new(&scene, &source, registry, OutputOptions { folder, existing, resume: false })?;
    if failed.exists() && ranks::is_first() {
        std::fs::remove_file(&failed).map_err(|error| {
            CommandFailure::Run(format!(
                "`{}` of an earlier run cannot be removed: {error}",
                failed.display()
            ))
        })?;
    }
    Ok(execution)
}
