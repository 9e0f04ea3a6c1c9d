//! The program as its users call it.
#![allow(dead_code, reason = "every test uses a part")]

use std::path::Path;
use std::process::{Command, Output, Stdio};

/// The program, to be started in a folder.
pub fn command(folder: impl AsRef<Path>, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshless"));
    command.args(arguments).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs the program in a folder.
pub fn meshless(folder: impl AsRef<Path>, arguments: &[&str]) -> Output {
    command(folder, arguments).output().expect("the program starts")
}

/// What it has printed.
pub fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What it has complained of.
pub fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Panics with all that was printed where the program has failed.
pub fn assert_success(output: &Output) {
    assert!(output.status.success(), "exit {:?}\n{}\n{}", output.status.code(), out(output), err(output));
}
