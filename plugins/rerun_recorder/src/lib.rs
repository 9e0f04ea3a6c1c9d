//! Recordings for the rerun viewer.
//!
//! A recording opens as it should be looked at: the bodies as points of the right radius, coloured by a
//! field, with a colour bar; beside them energies, the error of their balance, and probes over the simulated
//! time. A frame can be read back and drawn as a picture, without a viewer and without a screen.
//!
//! Without the feature `rerun` the plugin knows its parameters and writes nothing.

#[cfg(feature = "rerun")]
mod camera;
mod colormap;
#[cfg(feature = "rerun")]
mod picture;
mod plugin;
#[cfg(feature = "rerun")]
mod reading;
#[cfg(feature = "rerun")]
mod recording;
#[cfg(not(feature = "rerun"))]
#[path = "without_rerun.rs"]
mod recording;
#[cfg(feature = "surfaces")]
mod surface;

pub use colormap::Colormap;
#[cfg(feature = "rerun")]
pub use picture::{DrawStyle, draw};
pub use plugin::{RerunRecorder, register};
#[cfg(feature = "rerun")]
pub use reading::{ReadError, RecordedBody, RecordedFrame, read_frame};
#[cfg(feature = "rerun")]
pub use recording::{RerunError, RerunFile, WebViewer, WebViewerError};
#[cfg(feature = "surfaces")]
pub use surface::{SurfaceError, SurfaceMesh, surface_of};
