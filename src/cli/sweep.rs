//! `meshless sweep`: a scene once for every combination of values, and one table of the probes at the end.

use std::path::PathBuf;

use clap::Args;
use meshless_engine::assembly::name_problems;
use meshless_engine::plugin::Registry;
use meshless_engine::record::{Existing, OutputOptions};
use meshless_engine::scene::{self, Scene, Source};

use super::execution::{Execution, How};
use super::failure::CommandFailure;
use super::folder::default_folder;
use super::interrupt::Interrupt;
use super::scene_file::replacement;
use super::text::{complain, say};

mod cases;
mod report;

use cases::SweepCase;
use report::SweepRow;

/// Run a scene once for every combination of values, and compare the probes
#[derive(Args)]
pub struct SweepArguments {
    /// Scene file
    #[arg(value_name = "SCENE")]
    path: PathBuf,
    /// Values of the scene, separated by commas, as in `parameters.dx=0.01,0.005`; may be given several times
    #[arg(long = "set", value_name = "PATH=VALUES", value_parser = replacement, required = true)]
    set: Vec<(String, String)>,
    /// Folder to write to; every run has a folder of its own in it [default: out/<scene>]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Overwrite the output of an earlier sweep
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    how: How,
}

/// Runs all cases, one after the other.
pub fn execute(arguments: &SweepArguments, registry: &Registry) -> Result<(), CommandFailure> {
    let cases = cases::combinations(&arguments.set).map_err(CommandFailure::Usage)?;
    let names = |scene: &Scene| name_problems(scene, registry);
    // All scenes are read before the first one runs.
    let scenes = cases
        .iter()
        .map(|case| scene::load_checked(&arguments.path, &case.settings, &names))
        .collect::<Result<Vec<(Scene, Source)>, _>>()?;
    arguments.how.prepare()?;
    let interrupt = Interrupt::listen()?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.path));
    let existing = if arguments.force { Existing::Replace } else { Existing::Refuse };
    let mut rows = Vec::new();
    let mut failures = 0;
    for (k, (case, (scene, source))) in cases.iter().zip(&scenes).enumerate() {
        if !arguments.how.quiet {
            complain(&format!("run {} of {}: {}", k + 1, cases.len(), case.label()));
        }
        let options = OutputOptions { folder: folder.join(case.folder()), existing, resume: false };
        let mut execution = Execution::new(scene, source, registry, options)?;
        let row = run(case, &mut execution, &arguments.how);
        failures += usize::from(row.is_failed());
        rows.push(row);
        if interrupt.asked() {
            break;
        }
    }
    let file = report::write(&folder, existing, &rows)?;
    say(&report::text(&rows));
    say(&format!("table of all runs: {}", file.display()));
    if interrupt.asked() {
        return Err(CommandFailure::Interrupted(interrupt.signal()));
    }
    match failures {
        0 => Ok(()),
        failures => Err(CommandFailure::Run(format!("{failures} of {} runs failed", cases.len()))),
    }
}

/// One run. A failure is reported in its row, so that the others still run.
fn run(case: &SweepCase, execution: &mut Execution, how: &How) -> SweepRow {
    let quiet = How { quiet: true, threads: None, instructions: None, ..*how };
    match execution.carry_out(&quiet) {
        Ok(()) | Err(CommandFailure::Interrupted(_)) => {}
        Err(failure) => failure.report(),
    }
    SweepRow::new(case, execution.sim.summary())
}
