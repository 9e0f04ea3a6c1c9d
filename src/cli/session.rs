//! The loop over the steps of a run, and how it ends.

use std::path::{Path, PathBuf};

use clap::Args;
use meshless_engine::scene::Source;
use meshless_engine::simulation::{RunError, Simulation};

use super::failure::Failure;
use super::folder;
use super::interrupt::Interrupt;
use super::profile;
use super::progress::Progress;
use super::summary;
use super::text::{complain, say};

/// How a run is carried out; what it computes does not depend on any of this.
#[derive(Args)]
pub struct How {
    /// Number of threads; without it, all cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Stop after this many steps and leave a checkpoint
    #[arg(long, value_name = "N")]
    pub steps: Option<u64>,
    /// Print the time that each system has taken
    #[arg(long)]
    pub profile: bool,
    /// Print nothing but errors and warnings
    #[arg(long)]
    pub quiet: bool,
}

impl How {
    /// Sets the number of threads of this program; once, before anything runs.
    pub fn set_threads(&self) -> Result<(), Failure> {
        let Some(threads) = self.threads else { return Ok(()) };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads));
        pool.build_global().map_err(|error| Failure::Run(format!("cannot start {threads} threads: {error}")))
    }
}

/// Why a run has ended.
pub enum Ending {
    /// It has reached its end time.
    Complete,
    /// A system has asked to stop; the reason.
    Stopped(String),
    /// The number of steps that was asked for is done.
    StepLimit,
    /// Ctrl-C.
    Interrupted,
    /// A step failed.
    Failed(RunError),
}

/// A simulation with the scene it was built from and the folder it writes to.
pub struct Session {
    /// The simulation.
    pub sim: Simulation,
    /// Its scene.
    pub source: Source,
    /// Where it writes.
    pub folder: PathBuf,
}

impl Session {
    /// Does the steps, shows how far they are, and reports at the end.
    pub fn carry_out(mut self, how: &How) -> Result<(), Failure> {
        let interrupt = Interrupt::listen()?;
        let mut progress = Progress::new(&self.sim, how.quiet);
        let ending = self.steps(how.steps, &interrupt, &mut progress);
        progress.finish();
        let checkpoint = self.leave_checkpoint(&ending)?;
        for warning in self.sim.warnings() {
            complain(&format!("warning: {warning}"));
        }
        if !how.quiet {
            say(&summary::text(&self, &ending, &progress));
        }
        if how.profile {
            say(&profile::text(&self.sim, &progress));
        }
        if let (Some(checkpoint), false, false) =
            (&checkpoint, how.quiet, matches!(ending, Ending::Failed(_)))
        {
            say(&format!("to go on: meshless resume {}", checkpoint.display()));
        }
        match ending {
            Ending::Complete | Ending::Stopped(_) | Ending::StepLimit => Ok(()),
            Ending::Interrupted => Err(Failure::Interrupted),
            Ending::Failed(error) => Err(Failure::Run(match checkpoint {
                Some(state) => format!("{error}\nthe state is in {}", state.display()),
                None => error.to_string(),
            })),
        }
    }

    fn steps(&mut self, limit: Option<u64>, interrupt: &Interrupt, progress: &mut Progress) -> Ending {
        if let Err(error) = self.sim.start() {
            return Ending::Failed(error);
        }
        loop {
            if let Some(reason) = self.sim.stop_reason() {
                return Ending::Stopped(reason.to_owned());
            }
            if self.sim.is_finished() {
                return Ending::Complete;
            }
            if interrupt.asked() {
                return Ending::Interrupted;
            }
            if limit.is_some_and(|limit| progress.steps(&self.sim) >= limit) {
                return Ending::StepLimit;
            }
            if let Err(error) = self.sim.step() {
                return Ending::Failed(error);
            }
            progress.update(&self.sim);
        }
    }

    /// Saves the state of a run that has not come to its end.
    fn leave_checkpoint(&self, ending: &Ending) -> Result<Option<PathBuf>, Failure> {
        let name = match ending {
            Ending::Complete | Ending::Stopped(_) => return Ok(None),
            Ending::StepLimit | Ending::Interrupted => folder::CHECKPOINT,
            Ending::Failed(_) => folder::FAILED,
        };
        let path = self.folder.join(name);
        let source = Source::new(absolute(&self.source.name), self.source.text.clone());
        match (self.sim.save(&path, &source), ending) {
            (Ok(()), _) => Ok(Some(path)),
            (Err(error), Ending::Failed(_)) => {
                complain(&format!("warning: the state could not be saved: {error}"));
                Ok(None)
            }
            (Err(error), _) => Err(Failure::Run(error.to_string())),
        }
    }
}

/// Files that a scene names are relative to its folder, also for a run that goes on from elsewhere.
fn absolute(name: &str) -> String {
    std::path::absolute(Path::new(name)).map_or_else(|_| name.to_owned(), |path| path.display().to_string())
}
