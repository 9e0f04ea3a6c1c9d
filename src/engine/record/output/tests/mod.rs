//! Runs of small scenes and the files they leave.

mod failing;
mod files;
mod periodic;
mod recorder;
mod resume;
mod scene_errors;
mod stop;

use std::fs;
use std::path::Path;

use crate::assembly::{BuildOptions, build_with};
use crate::plugin::Registry;
use crate::record::Existing;
use crate::record::OutputOptions;
use crate::scene::{Scene, SceneError, Source, parse};
use crate::simulation::Simulation;

/// A cantilever of 24 particles that sags under gravity, with one probe of each kind; `change` edits the
/// text.
fn cantilever(change: impl Fn(String) -> String) -> (Scene, Source) {
    let text = r#"Scene(
    title: "Cantilever",
    dimension: Two,
    gravity: (0.0, -9.81),
    materials: {"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)},
    bodies: [
        Body(name: "beam", material: "rubber", shape: Box(min: (0.0, 0.0), max: (0.08, 0.03)), spacing: 0.01,
             formulation: TotalLagrangian),
    ],
    conditions: [Fix(on: Select(face: MinX))],
    time: (end: 0.02, step: Fixed(1.0e-4)),
    probes: [
        Probe(name: "tip", on: Select(nearest: (0.08, 0.03)), quantity: Displacement, every: 0.001),
        Probe(name: "support", on: Select(face: MinX), quantity: Force),
        Probe(name: "middle", at: (0.04, 0.012), quantity: Field("stress.xx")),
        Probe(name: "energies", quantity: Energy),
    ],
    record: (every: 0.004, fields: ["von_mises", "velocity"], checkpoint_every: 0.005, vtk: true),
)
"#;
    parse(Source::new("scenes/cantilever.ron", change(text.to_owned()))).unwrap_or_else(|e| panic!("{e}"))
}

fn options(folder: &Path, existing: Existing, resume: bool) -> BuildOptions {
    BuildOptions { output: Some(OutputOptions { folder: folder.to_path_buf(), existing, resume }) }
}

fn try_build((scene, source): &(Scene, Source), options: &BuildOptions) -> Result<Simulation, SceneError> {
    build_with(scene, source, &Registry::standard(), options)
}

fn built(scene: &(Scene, Source), folder: &Path) -> Simulation {
    try_build(scene, &BuildOptions::into_folder(folder)).unwrap_or_else(|e| panic!("{e}"))
}

/// Runs to the end and closes.
fn run(mut sim: Simulation) -> Simulation {
    sim.run(|_| true).unwrap();
    sim.finish().unwrap();
    sim
}

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<String> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
