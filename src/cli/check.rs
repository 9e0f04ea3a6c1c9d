//! `meshless check`: what a scene will cost and whether it can run, without writing anything.

use std::fmt::Write;
use std::time::{Duration, Instant};

use clap::Args;
use meshless_engine::assembly;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Dimension, Scene};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Mass};

use super::failure::Failure;
use super::memory::resident_bytes;
use super::neighbors::Neighbors;
use super::scene_file::SceneFile;
use super::text::{Table, bytes, complain, counted, duration, say};

/// Check a scene: particles, neighbours, memory, time step, estimated time; nothing is written
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneFile,
    /// Print the systems in their order, with the columns that they read and write
    #[arg(long)]
    schedule: bool,
}

/// Wall time spent on trial steps.
const TRIAL: Duration = Duration::from_millis(500);
/// Largest number of trial steps.
const TRIAL_STEPS: u64 = 50;

/// Builds the scene, does some steps in memory, and says what was found.
pub fn execute(arguments: &Arguments, registry: &Registry) -> Result<(), Failure> {
    let (scene, source) = arguments.scene.load()?;
    let mut sim = assembly::build(&scene, &source, registry)?;
    sim.start().map_err(|error| Failure::Run(error.to_string()))?;
    let limit = sim.limit().map_or_else(|| "nothing".to_owned(), |limit| limit.by.clone());
    let mut text = header(&scene, &source.name);
    text += &bodies(&scene, &sim)?;
    text += &memory(&sim);
    let trial = Trial::run(&mut sim)?;
    text += &trial.describe(&sim, &limit);
    if arguments.schedule {
        let _ = write!(text, "\nschedule\n{}", sim.schedule().describe());
    }
    say(&text);
    for warning in sim.warnings() {
        complain(&format!("warning: {warning}"));
    }
    Ok(())
}

fn header(scene: &Scene, name: &str) -> String {
    let space = match scene.dimension {
        Dimension::Two => "two dimensions, plane strain",
        Dimension::Three => "three dimensions",
    };
    let title = if scene.title.is_empty() { "untitled" } else { &scene.title };
    format!("{name}: {title} ({space})\n\n")
}

fn bodies(scene: &Scene, sim: &Simulation) -> Result<String, Failure> {
    let mass_heading = match scene.dimension {
        Dimension::Two => "mass kg/m",
        Dimension::Three => "mass kg",
    };
    let headings = [
        "body",
        "formulation",
        "material",
        "particles",
        "spacing m",
        mass_heading,
        "neighbours",
        "least",
        "most",
    ];
    let mut table = Table::new(&headings, 6);
    for (k, (body, described)) in sim.world().bodies().iter().zip(&scene.bodies).enumerate() {
        let (view, rows) = sim.world().body_view(BodyId(k));
        let masses = view.read::<Mass>().map_err(|error| Failure::Run(error.to_string()))?;
        let mass: f64 = masses[rows.clone()].iter().map(|mass| mass.0).sum();
        let [mean, least, most] = match Neighbors::count(sim, BodyId(k))? {
            Some(count) => [format!("{:.1}", count.mean), count.least.to_string(), count.most.to_string()],
            None => ["-".to_owned(), "-".to_owned(), "-".to_owned()],
        };
        table.row([
            body.name.clone(),
            described.formulation.name().to_owned(),
            body.material.clone(),
            body.rows.len().to_string(),
            format!("{}", body.spacing),
            format!("{mass:.6}"),
            mean,
            least,
            most,
        ]);
    }
    Ok(table.render())
}

fn memory(sim: &Simulation) -> String {
    let particles = sim.world().len();
    let columns = sim.world().bytes();
    let mut text = format!(
        "\nparticles  {particles}\nmemory     {} of columns, {} B per particle",
        bytes(columns),
        columns / particles.max(1)
    );
    if let Some(resident) = resident_bytes() {
        let _ = write!(text, "; the whole program takes {}", bytes(resident));
    }
    text + "\n"
}

/// Some steps to measure the speed with.
struct Trial {
    steps: u64,
    wall: f64,
    dt: f64,
}

impl Trial {
    fn run(sim: &mut Simulation) -> Result<Self, Failure> {
        let begun = Instant::now();
        let mut dt = 0.0;
        while !sim.is_finished() && sim.clock().step < TRIAL_STEPS && begun.elapsed() < TRIAL {
            sim.step().map_err(|error| Failure::Run(error.to_string()))?;
            if sim.clock().step == 1 {
                dt = sim.clock().dt;
            }
        }
        Ok(Self { steps: sim.clock().step, wall: begun.elapsed().as_secs_f64(), dt })
    }

    fn describe(&self, sim: &Simulation, limit: &str) -> String {
        let steps = sim.end() / self.dt;
        let per_step = self.wall / self.steps.max(1) as f64;
        format!(
            "time step  {:.3e} s, limited by {limit}\n\
             length     about {} to {} s\n\
             run time   about {} on {} threads, without output ({} in {} trial steps)\n",
            self.dt,
            counted(steps.ceil(), "steps"),
            sim.end(),
            duration(steps * per_step),
            rayon::current_num_threads(),
            counted(sim.world().len() as f64 / per_step, "particle-steps/s"),
            self.steps,
        )
    }
}
