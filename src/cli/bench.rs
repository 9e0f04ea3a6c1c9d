//! `meshless bench`: speed of the program on the benchmark cases, with all diagnostics on and output off.
//!
//! A case is a scene of `benches/scenes/` at a given number of particles. It runs through the registry with
//! ledger, watchdog and adaptive step, as any scene does. Absolute figures differ from machine to machine:
//! only ratios of benchmarks measured in one call are meaningful.

mod apart;
mod bench_case;
mod machine;
mod measure;
mod report;

use std::time::Duration;

use clap::Args;
use meshless_engine::plugin::Registry;

use super::execution::take_instructions;
use super::failure::CommandFailure;
use super::text::say;
use super::values::{duration, particles, whole};
use bench_case::{BENCH_CASES, BenchCase};
use measure::{BenchSetUp, Measurement};

/// Measure the speed on benchmark cases: particle-steps/s, pairs/s, memory, share of each system
#[derive(Args)]
pub struct BenchArguments {
    /// Benchmarks to run; all if none is given
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Approximate numbers of particles; k and M stand for thousands and millions
    #[arg(long, value_delimiter = ',', default_value = "262k", value_parser = particles, value_name = "N")]
    particles: Vec<usize>,
    /// Numbers of threads
    #[arg(long, value_delimiter = ',', default_value = "1", value_name = "N", value_parser = whole(1..=1024_u16))]
    threads: Vec<u16>,
    /// Numbers of ranks, processes started by `mpirun`
    #[arg(long, value_delimiter = ',', default_value = "1", value_name = "N", value_parser = whole(1..=1024_u16))]
    ranks: Vec<u16>,
    /// Instruction path of the hot loops, such as `x86-64-v3`; without it, the best that the processor has
    #[arg(long, value_name = "PATH")]
    instructions: Option<String>,
    /// Minimum wall time of a measurement [s]
    #[arg(long, default_value_t = 3.0, value_parser = duration, value_name = "S")]
    seconds: f64,
    /// List the benchmarks without running them
    #[arg(long)]
    list: bool,
    /// Print the share of every system too
    #[arg(long)]
    profile: bool,
    /// Print one JSON object for each measurement, in place of tables
    #[arg(long)]
    json: bool,
    /// Measure in this process, not in one of its own for each measurement
    #[arg(long, hide = true)]
    here: bool,
}

/// All combinations of a number of ranks and a number of threads.
fn pairs(ranks: &[u16], threads: &[u16]) -> impl Iterator<Item = (u16, u16)> {
    ranks.iter().flat_map(|&ranks| threads.iter().map(move |&threads| (ranks, threads)))
}

/// Measures the benchmarks that were asked for.
pub fn execute(arguments: &BenchArguments, registry: &Registry) -> Result<(), CommandFailure> {
    let cases = chosen(&arguments.cases)?;
    if arguments.list {
        say(&report::list(&cases));
        return Ok(());
    }
    let instructions = arguments.instructions.as_deref();
    take_instructions(instructions)?;
    if !arguments.json {
        say(&report::heading(&machine::describe()));
    }
    let duration = Duration::from_secs_f64(arguments.seconds);
    for &particles in &arguments.particles {
        for case in &cases {
            for (ranks, threads) in pairs(&arguments.ranks, &arguments.threads) {
                let set_up = BenchSetUp { case, particles, ranks, threads, duration };
                let measurement = match arguments.here {
                    true => Measurement::take(&set_up, registry)?,
                    false => apart::take(&set_up, instructions)?,
                };
                say(&if arguments.json {
                    report::json(&measurement)?
                } else {
                    report::text(&measurement, arguments.profile)
                });
            }
        }
    }
    Ok(())
}

fn chosen(names: &[String]) -> Result<Vec<&'static BenchCase>, CommandFailure> {
    if names.is_empty() {
        return Ok(BENCH_CASES.iter().collect());
    }
    let find = |name: &String| {
        BENCH_CASES.iter().find(|case| case.name == name).ok_or_else(|| {
            let known: Vec<&str> = BENCH_CASES.iter().map(|case| case.name).collect();
            CommandFailure::Usage(format!(
                "unknown benchmark `{name}`; the benchmarks are {}",
                known.join(", ")
            ))
        })
    };
    names.iter().map(find).collect()
}
