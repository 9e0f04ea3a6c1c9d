//! Commands that several ranks execute together, started by `mpirun`.

use std::hash::{DefaultHasher, Hash, Hasher};

use meshless_engine::ranks;
use meshless_engine::simulation::RunError;

use super::failure::CommandFailure;
use super::text::{complain, speak};

/// Environment variables of MPI libraries: the number of processes, the number of this one, and the number of
/// processes on its machine.
const SIZES: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"];
const NUMBERS: [&str; 2] = ["OMPI_COMM_WORLD_RANK", "PMI_RANK"];
const LOCAL_SIZES: [&str; 2] = ["OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"];

fn number_in(names: &[&str]) -> Option<usize> {
    names.iter().find_map(|name| std::env::var(name).ok()?.parse().ok())
}

/// Lets only the first of several processes print.
pub fn let_the_first_speak() {
    speak(number_in(&NUMBERS).unwrap_or(0) == 0);
}

/// Number of processes that have been started together.
pub fn started() -> usize {
    number_in(&SIZES).unwrap_or(1)
}

/// Default number of threads of a rank: the cores of the machine over the number of ranks on it. None for a
/// program that runs alone.
pub fn usual_threads() -> Option<usize> {
    let here = number_in(&LOCAL_SIZES).filter(|_| started() > 1)?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Some((cores / here.max(1)).max(1))
}

/// Executes a command as one of the ranks, on a thread of the pool: parallel loops and exchanges begin there.
pub fn together<T: Send>(
    command: impl FnOnce() -> Result<T, CommandFailure> + Send,
) -> Result<T, CommandFailure> {
    match started() {
        1 => command(),
        size => rayon::scope(|_| on_ranks(size, command)),
    }
}

#[cfg(feature = "mpi")]
fn on_ranks<T>(_: usize, command: impl FnOnce() -> Result<T, CommandFailure>) -> Result<T, CommandFailure> {
    let started = mpi_ranks::MpiRanks::start().map_err(|error| CommandFailure::Run(error.to_string()))?;
    ranks::enter(std::rc::Rc::new(started), || {
        speak(ranks::is_first());
        let done = require_equal("program", env!("CARGO_PKG_VERSION"))
            .and_then(|()| require_equal("instruction path", meshless_engine::parallel::instruction_path()))
            .and_then(|()| command());
        // `mpirun` ends all processes as soon as one fails; the others may not have printed their errors yet.
        done.map_err(|failure| {
            failure.report();
            ranks::any(true);
            CommandFailure::Told(failure.code())
        })
    })
}

#[cfg(not(feature = "mpi"))]
fn on_ranks<T>(size: usize, _: impl FnOnce() -> Result<T, CommandFailure>) -> Result<T, CommandFailure> {
    Err(CommandFailure::Usage(format!(
        "{size} processes have been started together, and this program is built for one: build it with `--features mpi`"
    )))
}

/// Rejects ranks that differ in a value that must be the same for all of them.
pub fn require_equal(what: &str, value: &str) -> Result<(), CommandFailure> {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    match ranks::agree(hasher.finish()) {
        true => Ok(()),
        false => Err(CommandFailure::Usage(format!("all ranks must have the same {what}"))),
    }
}

/// The prepared value, if all ranks have succeeded. A failure of this rank only is printed here.
pub fn all_or_none<T>(prepared: Result<T, CommandFailure>) -> Result<T, CommandFailure> {
    if !ranks::has_several() || !ranks::any(prepared.is_err()) {
        return prepared;
    }
    let is_common = ranks::agree(prepared.is_err().into());
    match prepared {
        Ok(_) => Err(CommandFailure::Run("another rank cannot begin".to_owned())),
        Err(failure) if !is_common => {
            speak(true);
            Err(failure)
        }
        Err(failure) => Err(failure),
    }
}

/// Ends all ranks if this one cannot write its output, which the others do not notice.
pub fn end_if_alone_with(error: &RunError) {
    if error.is_of_output() && ranks::has_several() {
        complain(&format!("error: {error}"));
        ranks::abort(1);
    }
}

/// Rejects a command that several processes cannot execute together.
pub fn require_one() -> Result<(), CommandFailure> {
    match started() {
        1 => Ok(()),
        size => Err(CommandFailure::Usage(format!(
            "this command runs in one process, found {size} started together; `run` and `resume` are carried out by several"
        ))),
    }
}
