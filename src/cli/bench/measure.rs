//! One measurement: a case at a number of particles on a number of threads.

use std::time::{Duration, Instant};

use meshless_engine::plugin::Registry;
use meshless_engine::ranks;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::BodyId;
use serde::{Deserialize, Serialize};

use super::super::failure::CommandFailure;
use super::super::memory::{processor_seconds, resident_bytes};
use super::super::neighbors::NeighborCounts;
use super::super::ranks::together;
use super::bench_case::BenchCase;
use super::machine;

/// Cycles of steps before the timing, in which lists and buffers reach their size.
const WARM_UP: u64 = 3;

/// The measurement to carry out.
#[derive(Clone, Copy)]
pub struct BenchSetUp<'a> {
    /// The case.
    pub case: &'a BenchCase,
    /// Number of particles, approximately.
    pub particles: usize,
    /// Ranks.
    pub ranks: u16,
    /// Threads of each.
    pub threads: u16,
    /// Minimum wall time of the measurement.
    pub duration: Duration,
}

/// Result of a measurement.
#[derive(Serialize, Deserialize)]
pub struct Measurement {
    /// Name of the case.
    pub case: String,
    /// Number of particles, without those of walls; of all where none has neighbours.
    pub particles: usize,
    /// Mean number of neighbours.
    pub neighbors: f64,
    /// Number of ranks, each with `threads` threads.
    pub ranks: u16,
    /// Number of threads of a rank.
    pub threads: u16,
    /// Number of timed steps.
    pub steps: u64,
    /// Sub-steps of stiff bodies in each of them; none if all bodies share one step.
    pub sub_steps: Option<f64>,
    /// Wall time of the timed steps, s.
    pub seconds: f64,
    /// Fraction of the time of the threads in which they ran: below one if other programs used the
    /// processors. None if the system does not report it.
    pub busy: Option<f64>,
    /// Particles times steps per second.
    pub particle_steps_per_second: f64,
    /// Directed pairs times steps per second.
    pub directed_pairs_per_second: f64,
    /// Growth of the resident memory of the program from before the scene was read to the end of the first
    /// step, per particle, B: the memory of walls counts, their particles do not. None if the system does not
    /// report it.
    pub bytes_per_particle: Option<f64>,
    /// Exchanges with other ranks in a step.
    pub exchanges_per_step: f64,
    /// Data received by a rank in a step, B.
    pub bytes_per_step: f64,
    /// Time from reading the scene to the end of the first step, s.
    pub first_step_after: f64,
    /// Time of every system, in the order of the step, s.
    pub systems: Vec<SystemTime>,
    /// The machine and the program.
    pub machine: machine::Machine,
}

/// Time of one system.
#[derive(Serialize, Deserialize)]
pub struct SystemTime {
    /// Label.
    pub label: String,
    /// Time, s.
    pub seconds: f64,
}

impl Measurement {
    /// Builds the case and times its steps.
    pub fn take(set_up: &BenchSetUp<'_>, registry: &Registry) -> Result<Self, CommandFailure> {
        let threads = set_up.threads;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build();
        let pool =
            pool.map_err(|error| CommandFailure::Run(format!("cannot start {threads} threads: {error}")))?;
        pool.install(|| together(|| Self::take_here(set_up, registry)))
    }

    fn take_here(set_up: &BenchSetUp<'_>, registry: &Registry) -> Result<Self, CommandFailure> {
        let BenchSetUp { case, particles, ranks, threads, duration } = *set_up;
        let failed = |error: &dyn std::fmt::Display| CommandFailure::Run(format!("{}: {error}", case.name));
        let before = resident_bytes();
        let begun = Instant::now();
        let scene = case.scene(particles).map_err(|error| failed(&error))?;
        let mut sim = scene.build(registry)?;
        sim.step().map_err(|error| failed(&error))?;
        let first_step_after = begun.elapsed().as_secs_f64();
        let after = resident_bytes();
        while sim.clock().step < WARM_UP * case.cycle {
            sim.step().map_err(|error| failed(&error))?;
        }
        let (first, timers, short) = (sim.clock().step, timers(&sim), short_steps(&sim));
        let (processor, traffic) = (processor_seconds(), ranks::traffic());
        let begun = Instant::now();
        while ranks::any(begun.elapsed() < duration) || sim.clock().step == first {
            for _ in 0..case.cycle {
                sim.step().map_err(|error| failed(&error))?;
            }
        }
        let seconds = begun.elapsed().as_secs_f64();
        let spent = processor.zip(processor_seconds()).map(|(before, after)| after - before);
        let (particles, neighbors) = moving(&sim)?;
        let steps = sim.clock().step - first;
        let now = ranks::traffic();
        let per_step = |before: u64, now: u64| (now - before) as f64 / steps as f64;
        let rate = particles as f64 * steps as f64 / seconds;
        let grown = before.zip(after).map(|(before, after)| after.saturating_sub(before) as f64);
        Ok(Self {
            case: case.name.to_owned(),
            particles,
            neighbors,
            ranks,
            threads,
            steps,
            sub_steps: short_steps(&sim).zip(short).map(|(now, before)| per_step(before, now)),
            seconds,
            busy: spent.map(|spent| spent / (seconds * f64::from(threads))),
            particle_steps_per_second: rate,
            directed_pairs_per_second: rate * neighbors,
            bytes_per_particle: grown.map(|grown| grown / particles.max(1) as f64),
            exchanges_per_step: per_step(traffic.exchanges, now.exchanges),
            bytes_per_step: per_step(traffic.bytes, now.bytes),
            first_step_after,
            systems: since(timers, &sim),
            machine: machine::describe(),
        })
    }
}

/// Sub-steps since time 0, where there are any.
fn short_steps(sim: &Simulation) -> Option<u64> {
    sim.sub_steps().map(|(_, total)| total)
}

fn timers(sim: &Simulation) -> Vec<Duration> {
    sim.schedule().timers().map(|(_, _, time)| time).collect()
}

fn since(before: Vec<Duration>, sim: &Simulation) -> Vec<SystemTime> {
    let timers = sim.schedule().timers().zip(before);
    timers
        .map(|((label, _, time), before)| SystemTime {
            label: label.to_owned(),
            seconds: (time - before).as_secs_f64(),
        })
        .collect()
}

/// Number of particles of the bodies that have neighbours, and their mean number of neighbours. Walls are not
/// counted, nor are rigid bodies if there are other bodies.
fn moving(sim: &Simulation) -> Result<(usize, f64), CommandFailure> {
    let (mut sum, mut particles) = (0.0, 0);
    for k in 0..sim.world().bodies().len() {
        let count = sim.world().body(BodyId(k)).rows.len();
        if let Some(neighbors) = NeighborCounts::count(sim, BodyId(k))? {
            sum += neighbors.mean * count as f64;
            particles += count;
        }
    }
    Ok(match particles {
        0 => (sim.world().bodies().iter().map(|body| body.rows.len()).sum(), 0.0),
        _ => (particles, sum / particles as f64),
    })
}
