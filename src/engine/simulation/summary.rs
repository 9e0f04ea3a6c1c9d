//! The results of a run, for people and for programs.

use std::collections::BTreeMap;
use std::time::Instant;

use serde::Serialize;

use super::Simulation;
use crate::formulations::fluid::FlowCloud;
use crate::parallel::instruction_path;
use crate::record::output::Extreme;
use crate::scene::Precision;
use crate::world::{Body, BodyId, Removed};

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case", tag = "how", content = "why")]
pub enum Outcome {
    /// It has reached its end time.
    Finished,
    /// A system has ended it, for the reason given.
    Stopped(String),
    /// It was ended from outside before its end time.
    Interrupted,
    /// It could not go on.
    Failed(String),
}

/// Results of a run.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Title of the scene.
    pub title: String,
    /// Values of the parameters of the scene.
    pub parameters: BTreeMap<String, f64>,
    /// Outcome.
    pub outcome: Outcome,
    /// Time reached, s.
    pub time: f64,
    /// Time at which it was to end, s.
    pub end_time: f64,
    /// Steps since time 0.
    pub steps: u64,
    /// Sub-steps of sub-cycled bodies since time 0; none where no body is sub-cycled.
    pub short_steps: Option<u64>,
    /// Length of the last step, s.
    pub last_dt: f64,
    /// Limit of the time step.
    pub limited_by: Option<String>,
    /// Number of particles.
    pub particles: usize,
    /// Number of particles of each body.
    pub particles_of: BTreeMap<String, usize>,
    /// Number of particles of each body that have been removed from the run; bodies that have lost none are
    /// left out.
    pub removed_of: BTreeMap<String, usize>,
    /// Time that passed from the start (or from the checkpoint on) to now, s.
    pub wall_seconds: f64,
    /// Particles times steps per second, since the start or the checkpoint.
    pub particle_steps_per_second: f64,
    /// Threads.
    pub threads: usize,
    /// Instruction path of the hot loops.
    pub instruction_path: String,
    /// Arithmetic of the sums over neighbours of fluids; none where nothing flows.
    pub precision: Option<Precision>,
    /// Energies, all bodies together, J.
    pub energies: BTreeMap<String, f64>,
    /// Energies of each body, J.
    pub energies_of: BTreeMap<String, BTreeMap<String, f64>>,
    /// The balance error, J.
    pub balance_error: f64,
    /// The same over the largest energy that any account has held.
    pub relative_error: f64,
    /// Minimum, maximum and last value of every column of every probe, with their times.
    pub probes: BTreeMap<String, Vec<Extreme>>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Sources of the methods in use.
    pub references: Vec<String>,
    /// Time taken by every system, in the order of the step.
    pub timings: Vec<Timing>,
}

/// Time taken by a system.
#[derive(Clone, Debug, Serialize)]
pub struct Timing {
    /// Label.
    pub system: String,
    /// Stage.
    pub stage: String,
    /// Time, s.
    pub seconds: f64,
}

/// When this process began to do steps, and at which step. Takes no part in any result.
#[derive(Debug, Default)]
pub(super) struct Throughput {
    began: Option<(Instant, u64)>,
}

impl Throughput {
    pub fn begin(&mut self, step: u64) {
        self.began = Some((Instant::now(), step));
    }

    /// Seconds and steps since.
    fn since(&self, step: u64) -> (f64, u64) {
        self.began.map_or((0.0, 0), |(instant, first)| (instant.elapsed().as_secs_f64(), step - first))
    }
}

impl Simulation {
    /// The results of the run so far.
    pub fn summary(&self) -> Summary {
        let (wall_seconds, steps) = self.pace.since(self.clock.step);
        let particles = self.world.len();
        let work = particles as f64 * steps as f64;
        let accounts = self.ledger.accounts();
        let bodies = || self.world.bodies().iter().enumerate();
        let of_body = |k| accounts.iter().map(|a| (a.name.clone(), a.of(BodyId(k)))).collect();
        let probes = self.output().map(|output| {
            output.extremes().map(|(name, extremes)| (name.to_owned(), extremes.to_vec())).collect()
        });
        Summary {
            title: self.title.clone(),
            parameters: self.parameters.clone(),
            outcome: self.outcome(),
            time: self.clock.time,
            end_time: self.end,
            steps: self.clock.step,
            short_steps: self.sub_steps().map(|(_, total)| total),
            last_dt: self.clock.dt,
            limited_by: self.next_limit.as_ref().map(|limit| limit.by.clone()),
            particles,
            particles_of: bodies().map(|(_, body)| (body.name.clone(), body.rows.len())).collect(),
            removed_of: self.removed_of(),
            wall_seconds,
            particle_steps_per_second: if wall_seconds > 0.0 { work / wall_seconds } else { 0.0 },
            threads: rayon::current_num_threads(),
            instruction_path: instruction_path().to_owned(),
            precision: self.resources.try_get::<FlowCloud>().map(|cloud| cloud.precision()),
            energies: accounts.iter().map(|a| (a.name.clone(), a.total())).collect(),
            energies_of: bodies().map(|(k, body)| (body.name.clone(), of_body(k))).collect(),
            balance_error: self.ledger.balance_error(),
            relative_error: self.ledger.relative_error(),
            probes: probes.unwrap_or_default(),
            warnings: self.warnings.clone(),
            references: self.references.clone(),
            timings: self
                .schedule
                .timers()
                .map(|(system, stage, time)| Timing {
                    system: system.to_owned(),
                    stage: format!("{stage:?}"),
                    seconds: time.as_secs_f64(),
                })
                .collect(),
        }
    }

    fn removed_of(&self) -> BTreeMap<String, usize> {
        let count = |body: &Body| {
            let removed = self.world.phase(body.phase).read::<Removed>();
            let gone = |rows: &[Removed]| rows.iter().filter(|row| **row != Removed::NO).count();
            removed.map_or(0, |removed| gone(&removed[body.rows.clone()]))
        };
        let counts = self.world.bodies().iter().map(|body| (body.name.clone(), count(body)));
        counts.filter(|(_, count)| *count > 0).collect()
    }

    fn outcome(&self) -> Outcome {
        if let Some(why) = &self.failure {
            Outcome::Failed(why.clone())
        } else if self.clock.time >= self.end {
            Outcome::Finished
        } else if let Some(why) = &self.stop {
            Outcome::Stopped(why.clone())
        } else {
            Outcome::Interrupted
        }
    }
}
