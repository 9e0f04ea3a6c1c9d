//! Recordings for the rerun viewer.
//!
//! A recording opens as it should be looked at: the bodies as points of the right radius, coloured by a field, with a
//! colour bar; beside them energies, the error of their balance, and probes over the simulated time.

mod blueprint;
mod camera;
mod color_scale;
mod colormap;
mod error;
mod layout;
mod legend;
mod notes;
mod output;
mod paths;
mod plugin;
mod recorder;
mod series;
mod web_viewer;

pub use colormap::Colormap;
pub use error::RerunError;
pub use plugin::{RerunRecorder, register};
pub use recorder::RerunFile;
pub use web_viewer::{WebViewer, WebViewerError};
