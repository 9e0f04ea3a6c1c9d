//! Output of a run and its file formats, for writing and reading.
//!
//! The formats are independent of world and scene: they write slices to files. A [`Recorder`] receives the
//! same slices. [`output`] decides when something is written, and where.

pub mod atomic;
pub mod container;
pub mod hash;
pub mod output;
pub mod probe;
pub mod recorder;
pub mod series;
mod stop;
pub mod vtk;
pub mod watchdog;

pub use crate::fields::{ChosenField, Field, FieldInput, FieldTable};
pub use atomic::{Existing, WriteError, write_atomically};
pub use container::{Container, ContainerError, ContainerWriter, Section};
pub use hash::{StateHash, StateHasher};
pub use output::{Output, OutputOptions, OutputPlan};
pub use recorder::{
    BodyFrame, BodyInfo, FieldValues, Frame, NamedUnit, RecordError, Recorder, RunInfo, Sample,
};
pub use series::{Series, SeriesColumn, SeriesError, SeriesWriter, read_series};
pub use vtk::{PointArray, PointValues, PvdFrame, PvdWriter, VtkError, write_vtu};
