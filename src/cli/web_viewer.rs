//! The web viewer of `meshless view`: serves rerun's viewer and the recording to a browser.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use rerun_recorder::WebViewer;

use super::failure::CommandFailure;
use super::view::has_display;

/// Serves rerun's web viewer until the program is stopped; a `port` of 0 takes any that is free.
pub fn serve(recording: &Path, port: u16, browser: bool) -> Result<(), CommandFailure> {
    let viewer = WebViewer::start(recording, port).map_err(|error| CommandFailure::Run(error.to_string()))?;
    let url = viewer.url();
    let text = format!(
        "{} in a browser, until Ctrl-C:\n  {url}\n\
         the viewer as a program of its own is faster: pip install rerun-sdk==0.36.3",
        recording.display()
    );
    // A reader of a pipe gets the address at once.
    let mut out = std::io::stdout();
    writeln!(out, "{text}")
        .and_then(|()| out.flush())
        .map_err(|error| CommandFailure::Run(error.to_string()))?;
    if browser && has_display() {
        open(&url);
    }
    viewer.wait();
    Ok(())
}

/// Opens an address in the browser of the desktop. If there is none, the printed address remains.
fn open(url: &str) {
    let mut command = if cfg!(target_os = "macos") {
        Command::new("open")
    } else if cfg!(windows) {
        let mut command = Command::new("rundll32");
        command.arg("url.dll,FileProtocolHandler");
        command
    } else {
        Command::new("xdg-open")
    };
    let quiet = command.arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // A desktop without a browser is no error.
    let _ = quiet.spawn();
}
