//! The recording itself, written with rerun.

mod add;
mod arrays;
mod blueprint;
mod color_scale;
mod error;
mod file;
mod layout;
mod legend;
mod notes;
mod output;
pub mod paths;
mod recorder;
mod series;
mod surface;
mod web_viewer;

pub use add::{add, check_address};
pub use error::RerunError;
pub use layout::BACKGROUND;
pub use output::TIMELINE;
pub use recorder::{RerunFile, up_of};
pub use web_viewer::{WebViewer, WebViewerError};
