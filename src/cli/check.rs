//! `meshless check`: the cost of a scene and whether it can run, without writing anything.

use std::collections::BTreeMap;
use std::fmt::Write;

use clap::Args;
use meshless_engine::assembly;
use meshless_engine::notation::{number, quantity};
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Dimension, Scene};
use meshless_engine::simulation::Simulation;
use serde::Serialize;

use super::failure::CommandFailure;
use super::memory::resident_bytes;
use super::scene_file::SceneFile;
use super::text::{TextTable, bytes, complain, say};

mod body;
mod review;
mod support;
mod trial;

use body::BodyReport;
use trial::TrialSteps;

/// Check a scene without writing anything: particles, neighbours, memory, time step, estimated run time, and
/// notes on its set-up
#[derive(Args)]
pub struct CheckArguments {
    #[command(flatten)]
    scene: SceneFile,
    /// Print the systems in their order, with the columns that they read and write
    #[arg(long)]
    schedule: bool,
    /// Print the report as JSON
    #[arg(long, conflicts_with = "schedule")]
    json: bool,
}

/// The report for programs.
#[derive(Serialize)]
struct CheckReport<'a> {
    title: &'a str,
    dimension: usize,
    parameters: &'a BTreeMap<String, f64>,
    bodies: &'a [BodyReport],
    particles: usize,
    bytes_of_columns: usize,
    time_step: f64,
    limited_by: &'a str,
    end: f64,
    steps: f64,
    sub_steps: Option<u32>,
    seconds: f64,
    threads: usize,
    notes: &'a [String],
    warnings: &'a [String],
}

/// Builds the scene, does some steps in memory, and prints the results.
pub fn execute(arguments: &CheckArguments, registry: &Registry) -> Result<(), CommandFailure> {
    let (scene, source) = arguments.scene.load(registry)?;
    let mut sim = assembly::build(&scene, &source, registry)?;
    sim.start().map_err(|error| CommandFailure::of_start(&error, &source))?;
    let bodies = BodyReport::all(&scene, &sim, registry)?;
    let memory = memory(&sim);
    let trial = TrialSteps::run(&mut sim, &source).inspect_err(|_| warn(&sim))?;
    let notes = review::notes(&scene, &bodies, &sim, &trial);
    if arguments.json {
        say(&json(&scene, &sim, &bodies, &trial, &notes)?);
        return Ok(());
    }
    let mut text =
        header(&scene, &source.name, &sim) + &table(&scene, &bodies) + &memory + &trial.describe(&sim);
    if !notes.is_empty() {
        let _ =
            write!(text, "\nnotes\n{}", notes.iter().map(|note| format!("  {note}\n")).collect::<String>());
    }
    if arguments.schedule {
        let _ = write!(text, "\nschedule\n{}", sim.schedule().describe());
    }
    say(&text);
    warn(&sim);
    Ok(())
}

/// Prints the warnings, also where the trial fails.
fn warn(sim: &Simulation) {
    for warning in sim.warnings() {
        complain(&format!("warning: {warning}"));
    }
}

fn json(
    scene: &Scene,
    sim: &Simulation,
    bodies: &[BodyReport],
    trial: &TrialSteps,
    notes: &[String],
) -> Result<String, CommandFailure> {
    let report = CheckReport {
        title: &scene.title,
        dimension: scene.dimension.count(),
        parameters: sim.parameters(),
        bodies,
        particles: sim.world().len(),
        bytes_of_columns: sim.world().bytes(),
        time_step: trial.dt,
        limited_by: &trial.limit,
        end: sim.end(),
        steps: trial.expected_steps(sim),
        sub_steps: sim.sub_steps().map(|(last, _)| last),
        seconds: trial.expected_seconds(sim),
        threads: rayon::current_num_threads(),
        notes,
        warnings: sim.warnings(),
    };
    serde_json::to_string_pretty(&report).map_err(|error| CommandFailure::Run(error.to_string()))
}

fn header(scene: &Scene, name: &str, sim: &Simulation) -> String {
    let space = match scene.dimension {
        Dimension::Two => "two dimensions, plane strain",
        Dimension::Three => "three dimensions",
    };
    let title = if scene.title.is_empty() { "untitled" } else { &scene.title };
    let values = sim.parameters().iter().map(|(name, value)| format!("{name} = {}", number(*value)));
    let values = values.collect::<Vec<_>>().join(", ");
    let parameters = if values.is_empty() { values } else { format!("parameters: {values}\n") };
    format!("{name}: {title} ({space})\n{parameters}\n")
}

fn table(scene: &Scene, bodies: &[BodyReport]) -> String {
    let mass = match scene.dimension {
        Dimension::Two => "mass kg/m",
        Dimension::Three => "mass kg",
    };
    let headings = [
        "body",
        "formulation",
        "material",
        "particles",
        "spacing",
        "across",
        mass,
        "sound",
        "neighbours",
        "min",
        "max",
    ];
    let mut table = TextTable::new(&headings, 8);
    for body in bodies {
        let [mean, min, max] = match body.neighbours {
            Some((mean, min, max)) => [format!("{mean:.1}"), min.to_string(), max.to_string()],
            None => ["-".to_owned(), "-".to_owned(), "-".to_owned()],
        };
        table.row([
            body.name.clone(),
            body.formulation.clone(),
            body.material.clone(),
            body.particles.to_string(),
            quantity(body.spacing, "m"),
            number(body.across.round()),
            number(body.mass),
            body.sound_speed.map_or_else(|| "-".to_owned(), |speed| quantity(speed, "m/s")),
            mean,
            min,
            max,
        ]);
    }
    table.render()
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
