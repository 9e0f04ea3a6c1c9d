//! Trial steps in memory, to measure the speed.

use std::time::{Duration, Instant};

use meshless_engine::notation::{count, quantity, quantity_to};
use meshless_engine::scene::Source;
use meshless_engine::simulation::Simulation;

use crate::cli::failure::CommandFailure;
use crate::cli::text::{counted, duration};

/// Wall time spent on trial steps.
const TRIAL: Duration = Duration::from_millis(500);
/// Maximum number of trial steps.
const TRIAL_STEPS: u64 = 50;

/// Result of some trial steps.
pub struct TrialSteps {
    steps: u64,
    wall: f64,
    /// First step, s.
    pub dt: f64,
    /// Name of the limit.
    pub limit: String,
}

/// A number of steps as text, in full if a run can take so many.
fn steps(number: f64) -> String {
    if number < 1e9 { count(number as u64, "step") } else { format!("{} steps", quantity_to(number, "1", 2)) }
}

impl TrialSteps {
    /// Does the steps; the simulation has started.
    pub fn run(sim: &mut Simulation, source: &Source) -> Result<Self, CommandFailure> {
        let limit = sim.limit().map_or_else(|| "nothing".to_owned(), |limit| limit.by.clone());
        let begun = Instant::now();
        let mut dt = 0.0;
        while !sim.is_finished() && sim.clock().step < TRIAL_STEPS && begun.elapsed() < TRIAL {
            sim.step().map_err(|error| CommandFailure::of_start(&error, source))?;
            if sim.clock().step == 1 {
                dt = sim.clock().dt;
            }
        }
        Ok(Self { steps: sim.clock().step, wall: begun.elapsed().as_secs_f64(), dt, limit })
    }

    /// Steps of the whole run, at the first step.
    pub fn expected_steps(&self, sim: &Simulation) -> f64 {
        (sim.end() / self.dt).ceil()
    }

    /// Wall time of the whole run, s.
    pub fn expected_seconds(&self, sim: &Simulation) -> f64 {
        sim.end() / self.dt * self.wall / self.steps.max(1) as f64
    }

    /// The lines of the report.
    pub fn describe(&self, sim: &Simulation) -> String {
        let per_step = self.wall / self.steps.max(1) as f64;
        let time = duration(self.expected_seconds(sim));
        let about = if time.starts_with(|sign: char| sign.is_ascii_digit()) { "about " } else { "" };
        format!(
            "time step  {}, limited by {}\n\
             length     about {} to {}\n\
             run time   {about}{time} on {}, without output ({} in {})\n",
            quantity(self.dt, "s"),
            self.limit,
            steps(self.expected_steps(sim)),
            quantity(sim.end(), "s"),
            count(rayon::current_num_threads() as u64, "thread"),
            counted(sim.world().len() as f64 / per_step, "particle-steps/s"),
            count(self.steps, "trial step"),
        )
    }
}
