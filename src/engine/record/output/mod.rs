//! Everything that a run writes, by one system at the end of the step: what is due now, and only that.
//!
//! The order within a step: samples, frames, then, when all systems of the step are through, the checkpoint. So the
//! checkpoint holds the state of the output itself after this step, and files go on from there as if nothing had been.

mod due;
mod folder;
mod frames;
mod options;
mod plan;
mod present;
mod system;
mod table;
mod track;

pub use due::Output;
pub use folder::{CHECKPOINT, ENERGY, OutputFolder, SUMMARY};
pub use options::OutputOptions;
pub use plan::OutputPlan;
pub use system::{OUTPUT, OutputHandle};
pub use table::Extreme;

#[cfg(test)]
mod tests;
