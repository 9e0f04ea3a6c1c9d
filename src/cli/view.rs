//! `meshless view`: a recording in the rerun viewer.

use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;

use clap::Args;

use super::failure::Failure;
use super::folder;

/// Open a recording in the rerun viewer
#[derive(Args)]
pub struct Arguments {
    /// Recording (.rrd), or an output folder whose newest recording is meant
    #[arg(value_name = "RECORDING")]
    path: PathBuf,
}

/// Opens the viewer and waits until it is closed.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let recording = folder::recording(&arguments.path)?;
    let status = Command::new("rerun").arg(&recording).status().map_err(|error| match error.kind() {
        ErrorKind::NotFound => Failure::Run(format!(
            "the rerun viewer is not installed, or not where programs are looked for\n\
             install it with one of\n  \
             pip install rerun-sdk==0.36.3\n  \
             cargo install rerun-cli@0.36.3 --locked\n\
             and then open the recording with\n  \
             rerun {}",
            recording.display()
        )),
        _ => Failure::Run(format!("the rerun viewer cannot be started: {error}")),
    })?;
    if status.success() { Ok(()) } else { Err(Failure::Run(format!("the rerun viewer ended with {status}"))) }
}
