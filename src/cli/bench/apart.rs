//! A measurement in a process of its own: its memory is its own, and no earlier work has shaped the heap.

use std::process::{Command, Stdio};
use std::time::Duration;

use super::super::failure::Failure;
use super::measure::Measurement;
use super::work::Work;

/// Calls this program with the one work and reads what it measures.
pub fn take(
    work: &Work,
    particles: usize,
    threads: u16,
    least: Duration,
    instructions: Option<&str>,
) -> Result<Measurement, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::Run(format!("{}: {error}", work.name));
    let program = std::env::current_exe().map_err(|error| failed(&error))?;
    let output = Command::new(program)
        .args(["bench", work.name, "--json"])
        .args(["--particles", &particles.to_string()])
        .args(["--threads", &threads.to_string()])
        .args(["--seconds", &least.as_secs_f64().to_string()])
        .args(instructions.map(|path| format!("--instructions={path}")))
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| failed(&error))?;
    if !output.status.success() {
        return Err(failed(&"it could not be measured"));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| failed(&error))
}
