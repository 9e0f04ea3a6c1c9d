//! The time loop of a run and its end.

use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use clap::Args;
use meshless_engine::assembly::{self, BuildOptions};
use meshless_engine::notation::count;
use meshless_engine::parallel::take_instruction_path;
use meshless_engine::plugin::Registry;
use meshless_engine::ranks;
use meshless_engine::record::OutputOptions;
use meshless_engine::scene::{Scene, Source};
use meshless_engine::simulation::{RunError, Simulation};

use super::failure::CommandFailure;
use super::folder::{self, FAILED};
use super::interrupt::Interrupt;
use super::lock::Lock;
use super::profile;
use super::progress::ProgressLine;
use super::ranks::{all_or_none, end_if_alone_with, require_equal, together, usual_threads};
use super::summary;
use super::text::{complain, program, quoted, say, speaks};
use super::values::whole;

/// Maximum lag of the clock of the file system.
const CLOCK: Duration = Duration::from_millis(20);

/// Options of execution; results do not depend on any of them.
#[derive(Args, Clone)]
pub struct How {
    /// Number of threads; without it, all cores
    #[arg(long, value_name = "N", value_parser = whole(1..=1024_u16))]
    pub threads: Option<u16>,
    /// Instruction path of the hot loops, such as `x86-64-v3`; without it, the best that the processor has
    #[arg(long, value_name = "PATH")]
    pub instructions: Option<String>,
    /// Stop after this many steps and leave a checkpoint
    #[arg(long, value_name = "N", value_parser = whole(0..=u64::MAX))]
    pub steps: Option<u64>,
    /// Print the time that each system has taken
    #[arg(long)]
    pub profile: bool,
    /// Print nothing but errors and warnings
    #[arg(long)]
    pub quiet: bool,
}

impl How {
    /// Sets the number of threads and the instruction path of this program; once, before anything runs.
    pub fn prepare(&self) -> Result<(), CommandFailure> {
        take_instructions(self.instructions.as_deref())?;
        let Some(threads) = self.threads.map(usize::from).or_else(usual_threads) else { return Ok(()) };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build_global()
            .map_err(|error| CommandFailure::Run(format!("cannot start {threads} threads: {error}")))
    }
}

/// Selects the instruction path of this name, if one is given.
pub fn take_instructions(name: Option<&str>) -> Result<(), CommandFailure> {
    name.map_or(Ok(()), take_instruction_path).map_err(|error| CommandFailure::Usage(error.to_string()))
}

/// Prepares and runs a simulation on all ranks that have been started together.
pub fn carry_out_together(
    how: &How,
    prepare: impl FnOnce() -> Result<Execution, CommandFailure> + Send,
) -> Result<(), CommandFailure> {
    how.prepare()?;
    together(|| all_or_none(prepare())?.carry_out(how))
}

/// A simulation with the folder that it writes to.
pub struct Execution {
    /// The simulation.
    pub sim: Simulation,
    folder: PathBuf,
    source: Source,
    begun: SystemTime,
    _lock: Lock,
}

impl Execution {
    /// Builds the simulation.
    pub fn new(
        scene: &Scene,
        source: &Source,
        registry: &Registry,
        output: OutputOptions,
    ) -> Result<Self, CommandFailure> {
        let begun = SystemTime::now() - CLOCK;
        let folder = output.folder.clone();
        let sim = assembly::build_with(scene, source, registry, &BuildOptions { output: Some(output) })?;
        Ok(Self { sim, _lock: Lock::of(&folder)?, folder, source: source.clone(), begun })
    }

    /// Runs the time loop, shows its progress, and reports at the end.
    pub fn carry_out(&mut self, how: &How) -> Result<(), CommandFailure> {
        require_equal("scene", &self.source.text)?;
        let interrupt = Interrupt::listen()?;
        let mut progress = ProgressLine::new(&self.sim, how.quiet);
        // The loop runs on a thread of the pool: a parallel loop that starts outside the pool has to wake a
        // thread each time.
        let steps = match ranks::has_several() {
            true => self.steps(how.steps, &interrupt, &mut progress),
            false => rayon::scope(|_| self.steps(how.steps, &interrupt, &mut progress)),
        };
        progress.finish(&self.sim);
        if let Err(error) = &steps {
            end_if_alone_with(error);
        }
        if let Err(error) = &steps
            && progress.steps(&self.sim) == 0
            && error.problem().is_some()
        {
            return Err(CommandFailure::of_start(error, &self.source));
        }
        let failed_state = steps.is_err().then(|| self.keep_failed_state()).flatten();
        let finished = self.sim.finish();
        if let Err(error) = &finished {
            end_if_alone_with(error);
        }
        if let Ok(summary) = &finished {
            if how.quiet {
                // Those of the end are in the summary, which is not shown.
                progress.warn(&self.sim);
            } else {
                say(&summary::text(
                    summary,
                    self.sim.ledger(),
                    progress.steps(&self.sim),
                    &self.sim.state_hash(),
                ));
                // The list of files is a convenience: a folder that cannot be listed is no failure of the
                // run.
                if speaks()
                    && let Ok(files) = self.files()
                {
                    say(&files);
                }
            }
            if how.profile {
                say(&profile::text(summary, progress.steps(&self.sim)));
            }
        }
        if let Err(error) = steps {
            let kept = failed_state.map(|file| format!("\nthe state is kept in {}", file.display()));
            return Err(CommandFailure::of_run(&error, &self.source, kept.unwrap_or_default()));
        }
        finished.map_err(|error| CommandFailure::Run(error.to_string()))?;
        if ranks::any(interrupt.asked()) && !self.sim.is_finished() {
            Err(CommandFailure::Interrupted(interrupt.signal()))
        } else {
            Ok(())
        }
    }

    fn steps(
        &mut self,
        limit: Option<u64>,
        interrupt: &Interrupt,
        progress: &mut ProgressLine,
    ) -> Result<(), RunError> {
        self.sim.start()?;
        while !self.sim.is_finished() && !ranks::any(interrupt.asked()) {
            if limit.is_some_and(|limit| progress.steps(&self.sim) >= limit) {
                break;
            }
            self.sim.step()?;
            progress.update(&self.sim);
        }
        Ok(())
    }

    /// Saves the state of a failed run, beside the last checkpoint.
    fn keep_failed_state(&self) -> Option<PathBuf> {
        let file = self.folder.join(FAILED);
        match self.sim.save(&file, &self.source) {
            Ok(()) => Some(file),
            Err(error) => {
                complain(&format!("warning: the state could not be saved: {error}"));
                None
            }
        }
    }

    /// The files in the output folder, and the commands that use them.
    fn files(&self) -> Result<String, CommandFailure> {
        let (mut names, mut frames, mut earlier) = (Vec::new(), 0, 0);
        for file in folder::files(&self.folder)? {
            let written = file.metadata().and_then(|data| data.modified());
            if written.is_ok_and(|written| written < self.begun) {
                earlier += 1;
                continue;
            }
            match file.extension().and_then(|extension| extension.to_str()) {
                Some("vtu") => frames += 1,
                _ => names.extend(file.file_name().map(|name| name.display().to_string())),
            }
        }
        if frames > 0 {
            names.push(count(frames, "ParaView frame"));
        }
        if earlier > 0 {
            names.push(format!("and {} of earlier runs", count(earlier, "file")));
        }
        let folder = self.folder.display().to_string();
        let (program, quoted) = (program(), quoted(&folder));
        let mut text = format!("files in {folder}: {}", names.join(", "));
        text += &match names.iter().any(|name| name.ends_with(".rrd")) {
            true => format!("\nview the recording with: {program} view {quoted}"),
            false => "\nno recording: `plugins: [rerun_recorder()]` in the scene writes one".to_owned(),
        };
        if names.iter().any(|name| name == folder::CHECKPOINT) {
            text += &match self.sim.clock().time >= self.sim.end() {
                false => format!("\nresume with: {program} resume {quoted}"),
                true => format!("\nextend with: {program} resume {quoted} --until TIME"),
            };
        }
        Ok(text)
    }
}
