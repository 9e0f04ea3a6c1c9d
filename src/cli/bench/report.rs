//! Measurements as lines for people and as JSON for programs.

use std::fmt::Write;

use super::super::failure::CommandFailure;
use super::super::text::{TextTable, counted};
use super::bench_case::BenchCase;
use super::machine::Machine;
use super::measure::Measurement;

/// The benchmarks, one a line.
pub fn list(cases: &[&BenchCase]) -> String {
    cases.iter().map(|case| format!("{:<15} {}\n", case.name, case.title)).collect()
}

/// Heading: measured case and machine.
pub fn heading(machine: &Machine) -> String {
    format!(
        "{}, {}, meshless {}\n\
         {:<15} {:>10} {:>5} {:>7} {:>8} {:>9} {:>12} {:>14} {:>6} {:>12} {:>11} {:>14}",
        machine.processor,
        machine.instruction_path,
        machine.version,
        "case",
        "particles",
        "ranks",
        "threads",
        "neighb.",
        "sub-steps",
        "M p-steps/s",
        "M pairs/s",
        "busy",
        "B/particle",
        "1st step s",
        "MB exchanged",
    )
}

/// One line, and the share of every system under it if that is asked for.
pub fn text(measured: &Measurement, profile: bool) -> String {
    let bytes = measured.bytes_per_particle.map_or_else(|| "-".to_owned(), |bytes| format!("{bytes:.0}"));
    let busy = measured.busy.map_or_else(|| "-".to_owned(), |busy| format!("{:.0} %", 100.0 * busy));
    let sub_steps = measured.sub_steps.map_or_else(|| "-".to_owned(), |count| format!("{count:.2}"));
    let (bytes_per_step, exchanges) = (1e-6 * measured.bytes_per_step, measured.exchanges_per_step);
    let exchanged = match measured.ranks {
        1 => "-".to_owned(),
        _ => format!("{bytes_per_step:.2} in {exchanges:.0}"),
    };
    let mut text = format!(
        "{:<15} {:>10} {:>5} {:>7} {:>8.1} {:>9} {:>12.3} {:>14.1} {:>6} {:>12} {:>11.2} {:>14}",
        measured.case,
        counted(measured.particles as f64, "").trim_end(),
        measured.ranks,
        measured.threads,
        measured.neighbors,
        sub_steps,
        1e-6 * measured.particle_steps_per_second,
        1e-6 * measured.directed_pairs_per_second,
        busy,
        bytes,
        measured.first_step_after,
        exchanged,
    );
    if profile {
        let particle_steps = measured.steps as f64 * measured.particles as f64;
        let mut table = TextTable::new(&["system", "share", "ns/particle-step"], 2);
        for system in measured.systems.iter().filter(|system| system.seconds > 0.0) {
            table.row([
                system.label.clone(),
                format!("{:.1} %", 100.0 * system.seconds / measured.seconds),
                format!("{:.1}", 1e9 * system.seconds / particle_steps),
            ]);
        }
        let _ = write!(text, "\n{}", table.render());
    }
    text
}

/// One JSON object on one line.
pub fn json(measured: &Measurement) -> Result<String, CommandFailure> {
    serde_json::to_string(measured).map_err(|error| CommandFailure::Run(error.to_string()))
}
