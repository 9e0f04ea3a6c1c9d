//! Where a recording goes: a file, and a viewer if one is to watch the run.

use std::path::Path;
use std::time::{Duration, Instant};

use meshless_engine::record::Existing;
use re_sdk_types::archetypes::Scalars;
use rerun::external::{re_log_types, re_uri};
use rerun::log::TimeColumn;
use rerun::sink::{GrpcSink, GrpcSinkConnectionState, LogSink};
use rerun::{
    AsComponents, EntityPath, RecordingStream, RecordingStreamBuilder, RecordingStreamError, TimeCell,
};

use super::error::RerunError;
use super::file::RecordingFile;

/// Name under which the viewer groups recordings.
pub const APPLICATION: &str = "meshless";
/// The timeline of the simulated time.
pub const TIMELINE: &str = "sim_time";

/// For how long an answer of a viewer is waited for.
const PATIENCE: Duration = Duration::from_secs(5);
/// For how long the file is waited for.
const WRITING: Duration = Duration::from_secs(60);

/// A file and perhaps a viewer, which get the same. They are two streams, so that the file does not depend on
/// the viewer: the user may close it at any time.
pub struct RecordingOutput {
    file: RecordingStream,
    written: RecordingFile,
    viewer: Option<RecordingStream>,
}

/// A value of a time series.
#[derive(Clone, Copy, Debug)]
pub struct TimedValue {
    /// Step.
    pub step: u64,
    /// Time, s.
    pub time: f64,
    /// Value.
    pub value: f64,
}

impl RecordingOutput {
    /// Connects to the viewer and makes the file. Dropping the output completes the file.
    pub fn open(
        path: &Path,
        existing: Existing,
        name: &str,
        connect: Option<&str>,
    ) -> Result<Self, RerunError> {
        let reached = connect.map(reach).transpose()?;
        let written = RecordingFile::create(path, existing)?;
        let sinks: Vec<Box<dyn LogSink>> = vec![Box::new(written.clone())];
        let file =
            RecordingStreamBuilder::new(APPLICATION).enabled(true).recording_name(name).set_sinks(sinks)?;
        let viewer = match (reached, file.store_info()) {
            (Some(sink), Some(info)) => {
                let builder = RecordingStreamBuilder::from_store_id(&info.store_id);
                Some(builder.enabled(true).recording_name(name).set_sinks((sink,))?)
            }
            _ => None,
        };
        let output = Self { file, written, viewer };
        for stream in output.streams() {
            // When the program was at it is of no use to anyone, and would be offered as timelines.
            stream.set_log_time_enabled(false);
            stream.set_log_tick_enabled(false);
        }
        Ok(output)
    }

    fn streams(&self) -> impl Iterator<Item = &RecordingStream> {
        std::iter::once(&self.file).chain(&self.viewer)
    }

    /// Sets the time of what is logged from now on, s.
    pub fn set_time(&self, step: u64, time: f64) {
        for stream in self.streams() {
            stream.set_time_sequence("step", i64::try_from(step).unwrap_or(i64::MAX));
            stream.set_time(TIMELINE, TimeCell::from_duration_nanos(nanoseconds(time)));
        }
    }

    /// Sends the values of a time series in one piece.
    pub fn send_series(&self, path: &EntityPath, values: &[TimedValue]) -> Result<(), RerunError> {
        for stream in self.streams() {
            let steps = values.iter().map(|value| i64::try_from(value.step).unwrap_or(i64::MAX));
            let times = values.iter().map(|value| nanoseconds(value.time));
            let indexes =
                [TimeColumn::new_sequence("step", steps), TimeColumn::new_duration_nanos(TIMELINE, times)];
            let scalars = Scalars::new(values.iter().map(|value| value.value));
            let columns = scalars.columns_of_unit_batches().map_err(RecordingStreamError::from)?;
            stream.send_columns(path.clone(), indexes, columns)?;
        }
        Ok(())
    }

    /// Logs at the time that is set.
    pub fn log(&self, path: &EntityPath, data: &dyn AsComponents) -> Result<(), RerunError> {
        Ok(self.streams().try_for_each(|stream| stream.log(path.clone(), data))?)
    }

    /// Logs for all times.
    pub fn log_static(&self, path: &EntityPath, data: &dyn AsComponents) -> Result<(), RerunError> {
        Ok(self.streams().try_for_each(|stream| stream.log_static(path.clone(), data))?)
    }

    /// Sends a layout, `make` being called for each receiver.
    pub fn send_layout(
        &self,
        file_only: bool,
        make: impl Fn() -> Result<Vec<re_log_types::LogMsg>, RecordingStreamError>,
    ) -> Result<(), RerunError> {
        for stream in self.streams().take(if file_only { 1 } else { 2 }) {
            let messages = make()?;
            let Some(id) = messages.first().map(|message| message.store_id().clone()) else { continue };
            let activation = re_log_types::BlueprintActivationCommand {
                blueprint_id: id,
                make_active: true,
                make_default: true,
            };
            stream.send_blueprint(messages, activation);
        }
        Ok(())
    }

    /// Waits until all is in the file. The viewer is not waited for.
    pub fn flush(&self) -> Result<(), RerunError> {
        if let Some(viewer) = &self.viewer {
            // A viewer that was closed is no reason to stop.
            let _ = viewer.flush_async();
        }
        self.file.flush_with_timeout(WRITING)?;
        self.written.check()
    }

    /// Writes what is left, and the index of the file.
    pub fn complete(&self) -> Result<(), RerunError> {
        self.flush()?;
        self.written.complete()
    }
}

fn nanoseconds(time: f64) -> i64 {
    (time * 1e9).round() as i64
}

/// The address in the form that rerun knows; `127.0.0.1:9876` will do.
pub fn address(text: &str) -> Result<re_uri::ProxyUri, RerunError> {
    let full =
        if text.contains("://") { text.to_owned() } else { format!("rerun+http://{}/proxy", text.trim()) };
    full.parse().map_err(|_| RerunError::Address { address: text.to_owned() })
}

fn reach(text: &str) -> Result<GrpcSink, RerunError> {
    let sink = GrpcSink::new(address(text)?);
    let start = Instant::now();
    while !matches!(sink.status(), GrpcSinkConnectionState::Connected) {
        if start.elapsed() > PATIENCE {
            return Err(RerunError::NoViewer { address: text.to_owned(), waited: PATIENCE });
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    Ok(sink)
}
