//! Failures of commands, and their exit codes.

#[cfg(feature = "rerun")]
use meshless_engine::record::WriteError;
use meshless_engine::scene::{SceneError, Source};
use meshless_engine::simulation::RunError;
use thiserror::Error;

use super::interrupt::exit_code;
use super::text::{complain, in_colour};

/// Failure of a command.
#[derive(Debug, Error)]
pub enum CommandFailure {
    /// The scene cannot be used. Exit code 2.
    #[error("{0}")]
    Scene(SceneError),
    /// The command was called wrongly. Exit code 2.
    #[error("error: {0}")]
    Usage(String),
    /// The run failed, or a file could not be read or written. Exit code 1.
    #[error("error: {0}")]
    Run(String),
    /// An item of the scene failed in a run; where its state is kept. Exit code 1.
    #[error("{0}{1}")]
    Item(SceneError, String),
    /// Another of several ranks has printed the error already; its exit code.
    #[error("the run has failed")]
    #[cfg_attr(
        not(feature = "mpi"),
        expect(dead_code, reason = "a program built without MPI is one process")
    )]
    Told(u8),
    /// A signal stopped the run; its number. The exit code is 128 plus this number, as in shells.
    #[error("the run was interrupted")]
    Interrupted(u8),
}

impl CommandFailure {
    /// The failure of a run before its first step, or of a check: what fails then is the scene, if the error
    /// has a place in it.
    pub(super) fn of_start(error: &RunError, source: &Source) -> Self {
        match in_scene(error, source) {
            Some(error) => Self::Scene(error),
            None => Self::Run(error.to_string()),
        }
    }

    /// The failure of a run later; `kept` says where its state is kept.
    pub(super) fn of_run(error: &RunError, source: &Source, kept: String) -> Self {
        match in_scene(error, source) {
            Some(error) => Self::Item(error, kept),
            None => Self::Run(format!("{error}{kept}")),
        }
    }

    pub(super) fn report(&self) {
        match self {
            Self::Told(_) => {}
            Self::Scene(error) if in_colour() => complain(&error.styled()),
            Self::Item(error, kept) if in_colour() => complain(&format!("{}{kept}", error.styled())),
            Self::Usage(text) | Self::Run(text) if in_colour() => {
                complain(&format!("\u{1b}[1;31merror\u{1b}[0m: {text}"));
            }
            _ => complain(&self.to_string()),
        }
    }

    /// Its exit code.
    pub(super) fn code(&self) -> u8 {
        match self {
            Self::Scene(_) | Self::Usage(_) => 2,
            Self::Run(_) | Self::Item(..) => 1,
            Self::Told(code) => *code,
            Self::Interrupted(signal) => exit_code(*signal),
        }
    }
}

/// The error of a run at its place in the scene, if it has one.
fn in_scene(error: &RunError, source: &Source) -> Option<SceneError> {
    error.problem().map(|problem| SceneError { source: source.clone(), problems: vec![problem] })
}

/// For commands with an option `--force`.
#[cfg(feature = "rerun")]
impl From<WriteError> for CommandFailure {
    fn from(error: WriteError) -> Self {
        Self::Run(match error {
            WriteError::Exists { path } => {
                format!(
                    "`{}` already exists; `--force` replaces it, `--out` writes another file",
                    path.display()
                )
            }
            error => error.to_string(),
        })
    }
}

impl From<SceneError> for CommandFailure {
    fn from(error: SceneError) -> Self {
        Self::Scene(error)
    }
}
