//! What the plugin does in a build without rerun: scenes stay valid, and the run says that there is no
//! recording.

use std::convert::Infallible;

use meshless_engine::plugin::SimBuilder;

use crate::plugin::RerunRecorder;

/// Addresses are checked by rerun alone.
pub fn check_address(_: &str) -> Result<(), Infallible> {
    Ok(())
}

/// Says that nothing is recorded.
pub fn add(_: RerunRecorder, _: Vec<String>, _: [f64; 3], sim: &mut SimBuilder<'_>) {
    sim.warn("no recording is written: this program was built without the feature `rerun`");
}
