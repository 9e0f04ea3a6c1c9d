//! All output of a run, written by one system at the end of the step: whatever is due, and nothing else.
//!
//! The order within a step is samples, frames and, after all systems of the step, the checkpoint. The
//! checkpoint therefore contains the state of the output after this step, and files continue from there
//! without a trace of the interruption.

mod due;
mod folder;
mod frames;
mod mean;
mod options;
mod plan;
mod present;
mod silent;
mod system;
mod table;
mod track;

pub use due::Output;
pub use folder::{CHECKPOINT, ENERGY, OutputFolder, SUMMARY};
pub use options::OutputOptions;
pub use plan::OutputPlan;
pub use system::OUTPUT;
pub use table::Extreme;

#[cfg(test)]
mod tests;
