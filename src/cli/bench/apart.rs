//! A measurement in a process of its own, so that its memory does not depend on earlier cases.

use std::process::{Command, Stdio};

use super::super::failure::CommandFailure;
use super::measure::{BenchSetUp, Measurement};

/// Runs one set-up in a new process of this program and reads its measurement.
pub fn take(set_up: &BenchSetUp<'_>, instructions: Option<&str>) -> Result<Measurement, CommandFailure> {
    let BenchSetUp { case, particles, ranks, threads, duration } = *set_up;
    let failed = |error: &dyn std::fmt::Display| CommandFailure::Run(format!("{}: {error}", case.name));
    let program = std::env::current_exe().map_err(|error| failed(&error))?;
    let mut command = match ranks {
        1 => Command::new(program),
        _ => {
            let mut command = Command::new("mpirun");
            command.args(["-n", &ranks.to_string()]).arg(program);
            command
        }
    };
    let output = command
        .args(["bench", case.name, "--json", "--here"])
        .args(["--particles", &particles.to_string()])
        .args(["--ranks", &ranks.to_string()])
        .args(["--threads", &threads.to_string()])
        .args(["--seconds", &duration.as_secs_f64().to_string()])
        .args(instructions.map(|path| format!("--instructions={path}")))
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| failed(&error))?;
    if !output.status.success() {
        return Err(failed(&"it could not be measured"));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| failed(&error))
}
