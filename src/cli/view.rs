//! `meshless view`: a recording in the rerun viewer, or in a browser where none is installed.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use super::failure::CommandFailure;
use super::folder;
use super::values::whole;
#[cfg(feature = "rerun")]
use super::web_viewer::serve;

/// Open a recording in the rerun viewer, or in a browser where no viewer is installed
#[derive(Args)]
pub struct ViewArguments {
    /// Recording (.rrd), or an output folder whose newest recording is meant
    #[arg(value_name = "RECORDING")]
    path: PathBuf,
    /// Show it in a browser even if the rerun viewer is installed
    #[arg(long)]
    web: bool,
    /// Port for the browser; 0 takes any that is free
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = whole(0..=u16::MAX))]
    port: u16,
    /// Only print the address for the browser
    #[arg(long)]
    no_browser: bool,
}

/// Opens the viewer and waits until it is closed.
pub fn execute(arguments: &ViewArguments) -> Result<(), CommandFailure> {
    let recording = folder::recording(&arguments.path)?;
    let in_browser = arguments.web || arguments.port != 0 || arguments.no_browser;
    if in_browser || !has_display() || !viewer(&recording)? {
        serve(&recording, arguments.port, !arguments.no_browser)?;
    }
    Ok(())
}

/// Runs the rerun viewer until it is closed; false if none is installed, or if it cannot open its window.
fn viewer(recording: &Path) -> Result<bool, CommandFailure> {
    match Command::new("rerun").arg(recording).status() {
        Ok(status) if status.success() => Ok(true),
        Ok(status) => {
            eprintln!("the rerun viewer ended with {status}; showing the recording in a browser instead");
            Ok(false)
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(CommandFailure::Run(format!("the rerun viewer cannot be started: {error}"))),
    }
}

/// Whether a window can be opened.
pub(super) fn has_display() -> bool {
    let named = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(any(target_os = "macos", windows)) || named("DISPLAY") || named("WAYLAND_DISPLAY")
}

/// A build without rerun has no web viewer.
#[cfg(not(feature = "rerun"))]
fn serve(recording: &Path, _port: u16, _browser: bool) -> Result<(), CommandFailure> {
    Err(CommandFailure::Run(format!(
        "this program was built without rerun and has no viewer of its own; `pip install rerun-sdk==0.36.3`, then `rerun {}`",
        recording.display()
    )))
}
