//! The interface of recorders: frames of particles, samples of time series.

use std::path::Path;

use thiserror::Error;

use super::atomic::{Existing, WriteError};
use super::series::SeriesError;
use super::vtk::VtkError;
use crate::plugin::SimBuilder;
use crate::scene::Dimension;

/// One field of a body's particles.
#[derive(Clone, Copy, Debug)]
pub struct FieldValues<'a> {
    /// Name, such as `von_mises`.
    pub name: &'a str,
    /// Unit, SI; `1` for a pure number.
    pub unit: &'a str,
    /// One number for each particle; of a vector its magnitude.
    pub values: &'a [f64],
}

/// A body's particles at one time.
#[derive(Clone, Copy, Debug)]
pub struct BodyFrame<'a> {
    /// Name of the body.
    pub name: &'a str,
    /// Current positions, m.
    pub positions: &'a [[f32; 3]],
    /// Radius with which neighbouring particles just touch: half the spacing, m.
    pub radius: f32,
    /// The fields that the body has, of those that were asked for.
    pub fields: &'a [FieldValues<'a>],
}

/// All particles at one time.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Steps done.
    pub step: u64,
    /// Time, s.
    pub time: f64,
    /// Bodies in scene order.
    pub bodies: &'a [BodyFrame<'a>],
}

/// One number of a time series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<'a> {
    /// Path of the series: `energy/kinetic`, `energy/plate/kinetic`, `probe/tip/x`.
    pub name: &'a str,
    /// Unit, SI; `1` for a pure number.
    pub unit: &'a str,
    /// Value.
    pub value: f64,
}

/// A body, as far as it does not change in a run.
#[derive(Clone, Copy, Debug)]
pub struct BodyInfo<'a> {
    /// Name.
    pub name: &'a str,
    /// Radius with which neighbouring particles just touch: half the spacing, m.
    pub radius: f32,
    /// Number of particles.
    pub particles: usize,
}

/// Name and unit of a field or a time series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedUnit<'a> {
    /// Name, as in [`FieldValues`] and [`Sample`].
    pub name: &'a str,
    /// Unit, SI; `1` for a pure number.
    pub unit: &'a str,
}

/// Facts of a run before its first frame.
#[derive(Clone, Copy, Debug)]
pub struct RunInfo<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Name of the scene: that of its file, without folder and extension.
    pub scene_name: &'a str,
    /// Text of the scene.
    pub scene_text: &'a str,
    /// Plane strain or three dimensions.
    pub dimension: Dimension,
    /// Bodies in scene order.
    pub bodies: &'a [BodyInfo<'a>],
    /// The fields that frames carry; a body has those that its particles have.
    pub fields: &'a [NamedUnit<'a>],
    /// The time series known at the start. An energy account that opens later adds one.
    pub series: &'a [NamedUnit<'a>],
    /// Sources of the methods in use.
    pub references: &'a [String],
    /// The folder of all that the run writes; it exists.
    pub output: &'a Path,
    /// What happens to a file that is there already.
    pub existing: Existing,
    /// Whether the run is resumed from a checkpoint: output up to `start_time` stays valid.
    pub resumed: bool,
    /// Time of the first frame or, for a resumed run, of the checkpoint, s.
    pub start_time: f64,
    /// Time at which the run ends, s.
    pub end_time: f64,
}

/// Why something could not be recorded.
#[derive(Debug, Error)]
pub enum RecordError {
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A time series could not be written or continued.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// A ParaView file could not be written.
    #[error(transparent)]
    Vtk(#[from] VtkError),
    /// A recorder failed.
    #[error("the recorder `{recorder}` failed: {message}")]
    Recorder {
        /// Name of the recorder.
        recorder: String,
        /// The error.
        message: String,
    },
}

/// Shows or keeps a run. A plugin adds one with [`SimBuilder::add_recorder`].
///
/// The calls come in this order: `start`, then frames and samples in the order of time (those of one time in
/// any order), `flush` between them, `finish`. Without an output folder, as in a check, a recorder is never
/// started.
pub trait Recorder: Send {
    /// Names of the fields that it needs in frames, beside those that the scene asks for in `record.fields`.
    fn fields(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names of the files in the output folder that it will write, so that nothing is overwritten by
    /// accident.
    fn files(&self, scene_name: &str) -> Vec<String> {
        let _ = scene_name;
        Vec::new()
    }

    /// The run starts, or is resumed from a checkpoint.
    ///
    /// # Errors
    /// Its output cannot be written.
    fn start(&mut self, run: &RunInfo<'_>) -> Result<(), RecordError>;

    /// A frame: at the start, then at the first step end at or after each due time, and at the end.
    ///
    /// # Errors
    /// Its output cannot be written.
    fn frame(&mut self, frame: &Frame<'_>) -> Result<(), RecordError>;

    /// Values of time series at one time, s.
    ///
    /// # Errors
    /// Its output cannot be written.
    fn samples(&mut self, step: u64, time: f64, samples: &[Sample<'_>]) -> Result<(), RecordError>;

    /// Makes the output so far readable even if the program is killed now; called after every frame and
    /// before every checkpoint.
    ///
    /// # Errors
    /// Its output cannot be written.
    fn flush(&mut self) -> Result<(), RecordError>;

    /// The run is over, at its end or before; `warnings` are those of the run.
    ///
    /// # Errors
    /// Its output cannot be written.
    fn finish(&mut self, warnings: &[String]) -> Result<(), RecordError>;
}

impl SimBuilder<'_> {
    /// Adds a recorder; the same as `extend::<Box<dyn Recorder>>`.
    pub fn add_recorder(&mut self, recorder: impl Recorder + 'static) {
        self.extend::<Box<dyn Recorder>>(Box::new(recorder));
    }
}
