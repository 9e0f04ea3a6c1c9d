//! The output folder of a run.

use std::path::PathBuf;

use crate::record::Existing;

/// Folder and options of the output of a run.
#[derive(Clone, Debug)]
pub struct OutputOptions {
    /// The folder; it is made if it is not there.
    pub folder: PathBuf,
    /// What happens to files of an earlier run.
    pub existing: Existing,
    /// The run will go on from a checkpoint: its files are continued once
    /// `Simulation::restore` has said where.
    pub resume: bool,
}
