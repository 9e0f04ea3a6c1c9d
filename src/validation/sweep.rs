//! The sweep: every plugin of fluids at its default on every shipped flow.
//!
//! Each plugin is added to those that the scene gives its fluids, or replaces the one of its name. The checks
//! hold for every flow: the volume of the fluid, which fills what is worn off solids, the signs of the
//! accounts, and that nothing is inside of a wall.

use anyhow::{Context, Result};
use meshless_engine::assembly;
use meshless_engine::formulations::fluid::{FlowCloud, Near};
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::{BodyKind, Registry};
use meshless_engine::scene::{self, BodyDescription, Source};
use meshless_engine::schedule::{Account, AccountKind};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, ReferenceVolume, Removed};

use crate::case::Case;
use crate::check::Check;

macro_rules! flows {
    ($($name:literal),*) => {
        const FLOWS: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../assets/scenes/", $name, ".ron")))),*];

        /// The whole sweep, a case for each flow. They are not in the list of cases: together they take an
        /// hour, and run only when requested by name.
        pub const CASES: &[Case] = &[$(Case {
            id: concat!("sweep-", $name),
            title: "every plugin of fluids at its default, 2 000 steps",
            resolutions: &[1],
            ci_resolution: 1,
            run: |registry, _| sweep_of(registry, $name, &[], 2000),
        }),*];
    };
}
flows!(
    "abrasive_flow",
    "abrasive_flow_3d",
    "dam_break",
    "dam_break_3d",
    "dam_break_obstacle",
    "elastic_gate",
    "floating_box",
    "sloshing",
    "taylor_green",
    "vortex_street",
    "water_on_plate",
    "water_wheel"
);

/// Folders of the scenes and the meshes that they name, for a program started in any folder.
const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/scenes");

/// Plugins of fluids, at their defaults if all parameters have one.
const PLUGINS: &[&str] = &[
    "density_diffusion()",
    "particle_shifting()",
    "tensile_control()",
    "xsph()",
    "artificial_viscosity()",
    "local_damping(rate: 1.0)",
];

/// Maximum fraction of all energy that walls may supply.
const WALLS: f64 = 0.05;

/// Names of the flows.
pub fn flows() -> impl Iterator<Item = &'static str> {
    FLOWS.iter().map(|(name, _)| *name)
}

/// Runs every plugin for so many steps on one of the flows, with values set as `--set path=value` does.
///
/// # Errors
/// No such flow, a value that cannot be set, or a run that fails.
pub fn sweep_of(registry: &Registry, flow: &str, set: &[(&str, &str)], steps: u64) -> Result<Vec<Check>> {
    let source = source_of(flow, set)?;
    let mut checks = Vec::new();
    for plugin in PLUGINS {
        checks.extend(run(registry, flow, source.clone(), plugin, steps)?);
    }
    Ok(checks)
}

/// The warnings of one of the flows within so many steps, with values set as `--set path=value` does.
///
/// # Errors
/// No such flow, a value that cannot be set, or a run that fails.
pub fn warnings_of(registry: &Registry, flow: &str, set: &[(&str, &str)], steps: u64) -> Result<Vec<String>> {
    // A program without a recorder would warn of its absence.
    let (scene, source) = scene::parse(without(source_of(flow, set)?, "rerun_recorder")?)?;
    let mut simulation = assembly::build(&scene, &source, registry)?;
    simulation.run(|simulation| simulation.clock().step < steps)?;
    Ok(simulation.warnings().to_vec())
}

fn source_of(flow: &str, set: &[(&str, &str)]) -> Result<Source> {
    let (_, text) = FLOWS.iter().find(|(name, _)| *name == flow).context("no such flow")?;
    let mut source = Source::new(format!("{SCENES}/{flow}.ron"), *text);
    for (path, value) in set {
        source = source.with_override(path, value).map_err(|problem| source.error(vec![problem]))?;
    }
    Ok(source)
}

fn run(registry: &Registry, flow: &str, source: Source, plugin: &str, steps: u64) -> Result<[Check; 5]> {
    let (scene, source) = scene::parse(with_plugin(source, plugin, registry)?)?;
    let plugin = name_of(plugin);
    let mut simulation = assembly::build(&scene, &source, registry)?;
    simulation.start()?;
    let at_start = volumes(&simulation);
    simulation.run(|simulation| simulation.clock().step < steps)?;
    let at_end = volumes(&simulation);
    let filled = [worn_volume(&simulation)?, 0.0];
    let change = |k: usize| ((at_end[k] - filled[k]) / at_start[k] - 1.0).abs();
    let name = |what: &str| format!("{flow} with {plugin}: {what}");
    let [accounts, walls] = given(&simulation);
    Ok([
        Check::below(name("change of volume"), change(0), 0.01, "a liquid"),
        Check::below(name("change of volume over occupied space"), change(1), 0.01, "a liquid"),
        Check::below(name("energy from accounts that take it"), accounts, 1e-3, "of all energy"),
        Check::below(name("energy from walls"), walls, WALLS, "of all energy"),
        Check::below(name("walls and bodies entered"), intrusions(&simulation), 0.5, "closed"),
    ])
}

/// The name of a plugin, from its text.
fn name_of(plugin: &str) -> &str {
    plugin.split('(').next().unwrap_or(plugin)
}

/// The scene with a plugin on all of its fluids, replacing the one of its name.
fn with_plugin(source: Source, plugin: &str, registry: &Registry) -> Result<Source> {
    let name = name_of(plugin);
    // A plugin of that name for all bodies would have no body left to act on.
    let (scene, mut source) = scene::parse(without(source, name)?)?;
    let flows =
        |body: &&BodyDescription| registry.body_kind(body.formulation.name()) == Some(BodyKind::Fluid);
    for body in scene.bodies.iter().filter(flows) {
        let others =
            body.plugins.iter().filter(|item| item.name() != name).map(|item| item.text().to_owned());
        let list: Vec<String> = others.chain([plugin.to_owned()]).collect();
        let set =
            source.with_override(&format!("bodies.{}.plugins", body.name), &format!("[{}]", list.join(", ")));
        source = set.map_err(|problem| source.error(vec![problem]))?;
    }
    Ok(source)
}

/// The scene without the plugin of that name for all bodies.
fn without(source: Source, name: &str) -> Result<Source> {
    let (scene, source) = scene::parse(source)?;
    let others = scene.plugins.iter().filter(|item| item.name() != name);
    let list: Vec<&str> = others.map(|item| item.text()).collect();
    if list.len() == scene.plugins.len() {
        return Ok(source);
    }
    let set = source.with_override("plugins", &format!("[{}]", list.join(", ")));
    Ok(set.map_err(|problem| source.error(vec![problem]))?)
}

/// Volume of the fluids by their density, m3, and the volume of particles away from surfaces over the space
/// that they occupy.
fn volumes(simulation: &Simulation) -> [f64; 2] {
    let cloud = simulation.resources().get::<FlowCloud>();
    let volume: f64 = (0..cloud.fluid).map(|i| cloud.volume(i)).sum();
    let (mut filled, mut count) = (0.0, 0.0);
    for i in 0..cloud.fluid {
        let mut sum = cloud.volume(i) * cloud.kernel.value(0.0);
        let mut first = DVec3::ZERO;
        cloud.for_each_neighbor(i, |near: &Near| {
            sum += near.volume * near.kernel;
            first += near.volume * near.weight * near.x_ij;
        });
        if first.length() * cloud.kernel.smoothing_length() < 0.1 {
            (filled, count) = (filled + sum, count + 1.0);
        }
    }
    [volume, filled / count]
}

/// Volume of the particles removed from what does not flow, m3.
fn worn_volume(simulation: &Simulation) -> Result<f64> {
    let (world, cloud) = (simulation.world(), simulation.resources().get::<FlowCloud>());
    let flows = |id: BodyId| cloud.groups.iter().any(|group| group.body == id && group.fluid().is_some());
    let mut sum = 0.0;
    for id in (0..world.bodies().len()).map(BodyId).filter(|&id| !flows(id)) {
        let (view, rows) = world.body_view(id);
        let (volume, removed) = (view.read::<ReferenceVolume>()?, view.read::<Removed>()?);
        sum += rows.filter(|&row| removed[row] != Removed::NO).map(|row| volume[row].0).sum::<f64>();
    }
    Ok(sum)
}

/// Maximum energy supplied by an account of dissipation, and by walls, over the largest account. Walls push
/// water on at the start and absorb as much when it arrives: a fraction is allowed for them.
fn given(simulation: &Simulation) -> [f64; 2] {
    let ledger = simulation.ledger();
    let total = |name: &str| ledger.total_named(name);
    let scale = ledger.accounts().iter().map(|account| total(&account.name).abs()).fold(0.0, f64::max);
    let of = |walls: bool| {
        let chosen = |account: &&Account| {
            account.kind == AccountKind::Dissipated && (account.name == "wall_pressure") == walls
        };
        let accounts = ledger.accounts().iter().filter(chosen);
        accounts.map(|account| -total(&account.name)).fold(0.0, f64::max) / scale
    };
    [of(false), of(true)]
}

/// Number of bodies and walls with particles inside of them.
fn intrusions(simulation: &Simulation) -> f64 {
    simulation.warnings().iter().filter(|text| text.contains(" is inside of ")).count() as f64
}
