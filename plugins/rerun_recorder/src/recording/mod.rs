//! The recording itself, written with rerun.

mod add;
mod blueprint;
mod camera;
mod color_scale;
mod error;
mod layout;
mod legend;
mod notes;
mod output;
mod paths;
mod recorder;
mod series;
mod web_viewer;

pub use add::{add, check_address};
pub use error::RerunError;
pub use recorder::RerunFile;
pub use web_viewer::{WebViewer, WebViewerError};
