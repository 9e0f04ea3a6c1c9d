//! Probes of flows: the readings of gauges and sensors of an experiment.

mod carrier;
mod flux;
mod images;
mod level;
mod nearest;
mod reaction;
mod resolve;
mod sensor;
#[cfg(test)]
mod tests;
mod watch;

pub use level::water_level;
pub(super) use resolve::resolve;
pub use sensor::pressure_on_face;
