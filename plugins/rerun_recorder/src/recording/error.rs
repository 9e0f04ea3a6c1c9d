//! Why a recording cannot be written.

use std::time::Duration;

use meshless_engine::record::{RecordError, WriteError};
use rerun::RecordingStreamError;
use rerun::sink::SinkFlushError;
use thiserror::Error;

/// Why a recording cannot be written.
#[derive(Debug, Error)]
pub enum RerunError {
    /// The file cannot be made.
    #[error(transparent)]
    File(#[from] WriteError),
    /// The address is none.
    #[error(
        "`{address}` is not the address of a viewer; write `127.0.0.1:9876` or `rerun+http://127.0.0.1:9876/proxy`"
    )]
    Address {
        /// The address.
        address: String,
    },
    /// No viewer answers.
    #[error("no viewer answers at `{address}` within {} s; start one with `rerun`, or leave `connect` out", waited.as_secs())]
    NoViewer {
        /// The address.
        address: String,
        /// For how long an answer was waited for.
        waited: Duration,
    },
    /// Data could not be handed over for writing.
    #[error("the recording cannot be written: {0}")]
    Stream(#[from] RecordingStreamError),
    /// Data did not reach the file.
    #[error("the recording cannot be written: {0}")]
    Flush(#[from] SinkFlushError),
    /// A surface could not be made.
    #[cfg(feature = "surfaces")]
    #[error(transparent)]
    Surface(#[from] crate::surface::SurfaceError),
    /// A frame came before the start of the run, or after its end.
    #[error("the recording is not open")]
    NotOpen,
}

impl From<RerunError> for RecordError {
    fn from(error: RerunError) -> Self {
        match error {
            RerunError::File(error) => Self::Write(error),
            other => Self::Recorder { recorder: "rerun_recorder".to_owned(), message: other.to_string() },
        }
    }
}
