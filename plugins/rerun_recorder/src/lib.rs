//! Recordings for the rerun viewer.
//!
//! A recording opens as it should be looked at: the bodies as points of the right radius, coloured by a field, with a
//! colour bar; beside them energies, the error of their balance, and probes over the simulated time.
//!
//! Without the feature `rerun` the plugin knows its parameters and writes nothing.

mod colormap;
mod plugin;
#[cfg(feature = "rerun")]
mod recording;
#[cfg(not(feature = "rerun"))]
#[path = "without_rerun.rs"]
mod recording;

pub use colormap::Colormap;
pub use plugin::{RerunRecorder, register};
#[cfg(feature = "rerun")]
pub use recording::{RerunError, RerunFile, WebViewer, WebViewerError};
