//! The recording itself, written with rerun.

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

use meshless_engine::plugin::SimBuilder;

use crate::plugin::RerunRecorder;

pub use error::RerunError;
pub use recorder::RerunFile;
pub use web_viewer::{WebViewer, WebViewerError};

/// Checks the address of a viewer, `host:port` or a full address of rerun.
///
/// # Errors
///
/// Text that is no address.
pub fn check_address(text: &str) -> Result<(), RerunError> {
    output::address(text).map(|_| ())
}

/// Adds the recorder of a scene.
pub fn add(settings: RerunRecorder, grey: Vec<String>, up: [f64; 3], sim: &mut SimBuilder<'_>) {
    let fields = sim.scene().record.fields.clone();
    sim.add_recorder(RerunFile::new(settings, fields, grey, up));
}
