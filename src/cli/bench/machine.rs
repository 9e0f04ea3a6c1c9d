//! The machine and the program of a measurement.

use meshless_engine::parallel::instruction_path;
use serde::{Deserialize, Serialize};

/// Machine data that must accompany a figure.
#[derive(Serialize, Deserialize)]
pub struct Machine {
    /// Model of the processor, as far as the system tells.
    pub processor: String,
    /// Instruction path of the hot loops.
    pub instruction_path: String,
    /// Version of the program.
    pub version: String,
}

/// This machine.
pub fn describe() -> Machine {
    Machine {
        processor: processor().unwrap_or_else(|| "unknown processor".to_owned()),
        instruction_path: instruction_path().to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    }
}

fn processor() -> Option<String> {
    let table = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = table.lines().find_map(|line| line.strip_prefix("model name"))?;
    Some(line.trim_start_matches([' ', '\t', ':']).to_owned())
}
