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
    /// The failure of a run that a value of its scene makes impossible; none for another error.
    pub(super) fn of_scene(error: &RunError, source: &Source) -> Option<Self> {
        let problem = error.problem()?;
        Some(Self::Scene(SceneError { source: source.clone(), problems: vec![problem] }))
    }

    /// The failure of a run of a scene.
    pub(super) fn of_run(error: &RunError, source: &Source) -> Self {
        Self::of_scene(error, source).unwrap_or_else(|| Self::Run(error.to_string()))
    }

    pub(super) fn report(&self) {
        match self {
            Self::Told(_) => {}
            Self::Scene(error) if in_colour() => complain(&error.styled()),
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
            Self::Run(_) => 1,
            Self::Told(code) => *code,
            Self::Interrupted(signal) => exit_code(*signal),
        }
    }
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
