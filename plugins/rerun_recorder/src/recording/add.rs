//! From the parameters of a scene to the recorder of its run.

use meshless_engine::plugin::SimBuilder;

use super::error::RerunError;
use super::output;
use super::recorder::RerunFile;
use crate::plugin::RerunRecorder;

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
