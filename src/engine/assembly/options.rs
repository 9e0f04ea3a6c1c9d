//! Options of a simulation beside its scene.

use std::path::PathBuf;

use crate::record::{Existing, OutputOptions};

/// Options of a simulation beside its scene. By default it writes nothing.
#[derive(Clone, Debug, Default)]
pub struct BuildOptions {
    /// Where the run writes; without it nothing touches the disk.
    pub output: Option<OutputOptions>,
}

impl BuildOptions {
    /// A run that writes into a new folder, or one without files of these names.
    pub fn into_folder(folder: impl Into<PathBuf>) -> Self {
        let output = OutputOptions { folder: folder.into(), existing: Existing::Refuse, resume: false };
        Self { output: Some(output) }
    }
}
