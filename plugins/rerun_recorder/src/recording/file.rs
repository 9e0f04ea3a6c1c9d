//! The file of a recording.
//!
//! rerun's own writer ends its thread at the first error, and whoever waits for that thread then waits for
//! ever: a full disk would hang the run. This one keeps the error for those who ask, and drops what comes
//! after it.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use meshless_engine::record::{Existing, WriteError};
use re_log_encoding::{EncodeError, Encoder, EncodingOptions};
use rerun::external::re_log_types::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};

use super::error::RerunError;

/// A recording on its way to a file; clones write the same one.
#[derive(Clone)]
pub struct RecordingFile {
    path: PathBuf,
    state: Arc<Mutex<State>>,
}

enum State {
    Open(Box<Encoder<File>>),
    Failed(EncodeError),
    /// It is complete, or its error has been reported.
    Closed,
}

impl RecordingFile {
    /// Makes the file.
    ///
    /// # Errors
    /// It cannot be made, or is there and may not be replaced.
    pub fn create(path: &Path, existing: Existing) -> Result<Self, RerunError> {
        let made = match existing {
            Existing::Refuse => File::create_new(path),
            Existing::Replace => File::create(path),
        };
        let file = made.map_err(|error| WriteError::new(path, error))?;
        let options = EncodingOptions::PROTOBUF_COMPRESSED;
        let encoder = Encoder::new_eager(rerun::build_info().version, options, file)
            .map_err(|error| of(path, error))?;
        Ok(Self { path: path.to_owned(), state: Arc::new(Mutex::new(State::Open(Box::new(encoder)))) })
    }

    /// Does `work`; after an error no more is done.
    fn with(&self, work: impl FnOnce(&mut Encoder<File>) -> Result<(), EncodeError>) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if let State::Open(encoder) = &mut *state
            && let Err(error) = work(encoder)
        {
            // What is there stays readable up to the last message: no index goes behind half of one.
            if let State::Open(encoder) = std::mem::replace(&mut *state, State::Failed(error)) {
                let _ = encoder.into_inner();
            }
        }
    }

    /// Says what has gone wrong since this was asked last.
    ///
    /// # Errors
    /// The first error of writing.
    pub fn check(&self) -> Result<(), RerunError> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        match std::mem::replace(&mut *state, State::Closed) {
            State::Failed(error) => Err(of(&self.path, error)),
            other => {
                *state = other;
                Ok(())
            }
        }
    }

    /// Writes the index at the end of the file; nothing can be written after it.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn complete(&self) -> Result<(), RerunError> {
        self.with(|encoder| encoder.finish().and_then(|()| encoder.flush_blocking()));
        self.check()?;
        *self.state.lock().unwrap_or_else(PoisonError::into_inner) = State::Closed;
        Ok(())
    }
}

/// The error as shown to the user.
fn of(path: &Path, error: EncodeError) -> RerunError {
    RerunError::File(WriteError::new(
        path,
        match error {
            EncodeError::Write(error) => error,
            other => io::Error::other(other),
        },
    ))
}

impl LogSink for RecordingFile {
    fn send(&self, message: LogMsg) {
        self.with(|encoder| encoder.append(&message).map(drop));
    }

    fn flush_blocking(&self, _: Duration) -> Result<(), SinkFlushError> {
        self.with(Encoder::flush_blocking);
        Ok(())
    }
}
