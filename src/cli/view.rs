//! `meshless view`: a recording in the rerun viewer, or in a browser where none is installed.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use rerun_recorder::WebViewer;

use super::failure::Failure;
use super::folder;

/// Open a recording in the rerun viewer, or in a browser where no viewer is installed
#[derive(Args)]
pub struct Arguments {
    /// Recording (.rrd), or an output folder whose newest recording is meant
    #[arg(value_name = "RECORDING")]
    path: PathBuf,
    /// Show it in a browser even if the rerun viewer is installed
    #[arg(long)]
    web: bool,
    /// Port for the browser; 0 takes any that is free
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Only print the address for the browser
    #[arg(long)]
    no_browser: bool,
}

/// Opens the viewer and waits until it is closed.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    let recording = folder::recording(&arguments.path)?;
    if arguments.web || arguments.port != 0 || arguments.no_browser {
        return serve(&recording, arguments);
    }
    let status = match Command::new("rerun").arg(&recording).status() {
        Ok(status) => status,
        Err(error) if error.kind() == ErrorKind::NotFound => return serve(&recording, arguments),
        Err(error) => return Err(Failure::Run(format!("the rerun viewer cannot be started: {error}"))),
    };
    if status.success() { Ok(()) } else { Err(Failure::Run(format!("the rerun viewer ended with {status}"))) }
}

/// Serves rerun's web viewer until the program is stopped.
fn serve(recording: &Path, arguments: &Arguments) -> Result<(), Failure> {
    let viewer =
        WebViewer::start(recording, arguments.port).map_err(|error| Failure::Run(error.to_string()))?;
    let url = viewer.url();
    let text = format!(
        "{} in a browser, until Ctrl-C:\n  {url}\n\
         the viewer as a program of its own is faster: pip install rerun-sdk==0.36.3",
        recording.display()
    );
    // Whoever reads the address from a pipe shall have it at once.
    let mut out = std::io::stdout();
    writeln!(out, "{text}").and_then(|()| out.flush()).map_err(|error| Failure::Run(error.to_string()))?;
    if !arguments.no_browser {
        open(&url);
    }
    viewer.wait();
    Ok(())
}

/// Opens an address in the browser of the desktop. Where there is none, the address has been printed.
fn open(url: &str) {
    let shown = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let mut command = if cfg!(target_os = "macos") {
        Command::new("open")
    } else if cfg!(windows) {
        let mut command = Command::new("rundll32");
        command.arg("url.dll,FileProtocolHandler");
        command
    } else if shown("DISPLAY") || shown("WAYLAND_DISPLAY") {
        Command::new("xdg-open")
    } else {
        return;
    };
    let quiet = command.arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // A desktop without a browser is no reason to stop.
    let _ = quiet.spawn();
}
