//! Probes of flows: what gauges and sensors of an experiment show.

mod flux;
mod level;
mod reaction;
mod resolve;
mod sensor;

pub(super) use resolve::resolve;
