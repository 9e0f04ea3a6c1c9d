//! Scene to simulation: materials, particles, plugins, systems, columns.

use std::any::Any;

use super::named_fields::with_neighbours;
use super::names::name_problems;
use super::options::BuildOptions;
use super::overlap;
use super::placement;
use super::placing::{Parsed, Placed, place_bodies};
use super::plausibility;
use super::spawn;
use super::{
    clamps, drawn_sides, face_on, gaps_at_repeats, lattice_edges, loaded_sides, locking, narrow_gaps,
    rows_on_faces, supports,
};
use crate::plugin::{EntryKind, FormulationEntry, Registry, Setup, SetupError, SimBuilder};
use crate::record::probe::ResolvedProbe;
use crate::record::{Output, OutputPlan, Recorder};
use crate::scene::{Item, Problem, Scene, SceneError, Source, SourcePlace};
use crate::schedule::{Resources, Schedule, Shared};
use crate::simulation::{Simulation, SimulationParts};
use crate::world::{BodyId, BodySet};

/// Makes a simulation that writes nothing out of a scene: [`build_with`] and no options.
///
/// # Errors
/// All that is wrong with the scene, each with its place in the file.
pub fn build(scene: &Scene, source: &Source, registry: &Registry) -> Result<Simulation, SceneError> {
    build_with(scene, source, registry, &BuildOptions::default())
}

/// Makes a simulation out of a scene. Nothing is kept where something is wrong.
///
/// # Errors
/// All that is wrong with the scene, each with its place in the file.
pub fn build_with(
    scene: &Scene,
    source: &Source,
    registry: &Registry,
    options: &BuildOptions,
) -> Result<Simulation, SceneError> {
    build_in(scene, source, registry, options)
        .map_err(|problems| SceneError { source: source.clone(), problems })
}

fn build_in(
    scene: &Scene,
    source: &Source,
    registry: &Registry,
    options: &BuildOptions,
) -> Result<Simulation, Vec<Problem>> {
    let misspelt = name_problems(scene, registry);
    if !misspelt.is_empty() {
        return Err(misspelt);
    }
    let Placed { mut bodies, phases, formulations, .. } = place_bodies(scene, source, registry)?;
    let misplaced = placement::problems(&bodies, scene);
    if !misplaced.is_empty() {
        return Err(misplaced);
    }
    crate::formulations::fluid::estimate_sound_speeds(&mut bodies, scene)?;
    let overlaps = overlap::problems(&bodies, scene, source.folder());
    if !overlaps.is_empty() {
        return Err(overlaps);
    }
    let mut sim = SimBuilder::new(scene, source.folder(), bodies, phases);
    clamps::warn(scene, registry, &mut sim);
    lattice_edges::warn(scene, registry, &mut sim);
    locking::warn(&mut sim);
    supports::place(scene, registry, &mut sim);
    drawn_sides::warn(scene, registry, &mut sim);
    loaded_sides::warn(scene, &mut sim);
    plausibility::warn(&mut sim);
    narrow_gaps::warn(&mut sim);
    rows_on_faces::warn(&mut sim);
    let recorder_items = build_plugins(scene, registry, &mut sim)?;
    face_on::warn(&mut sim);
    gaps_at_repeats::warn(&mut sim);
    crate::formulations::fluid::damp_sub_cycled_bodies(&mut sim);
    with_neighbours().for_each(|field| sim.add_field(field));
    assemble(scene, formulations, &mut sim)?;
    crate::formulations::fluid::add_systems(&mut sim).map_err(|error| at_scene(scene, error))?;
    crate::removal::add_system(&mut sim);
    for contact in &scene.contacts {
        sim.cite(registry.reference(EntryKind::ContactLaw, contact.law.name()));
    }
    crate::contact::add_systems(&mut sim, &|item, pair| registry.build_contact_law(item, pair))?;
    crate::integrate::add_systems(&mut sim);
    crate::record::watchdog::add_system(&mut sim);
    let plan = OutputPlan::resolve(&mut sim, &recorder_items)?;
    let probes = plan.probes();
    let output = options.output.as_ref().map(|options| plan.attach(&mut sim, source, options));
    sim.refuse_leftovers()?;
    start(scene, source, sim, Outputs { output, probes })
}

/// Output of a simulation.
struct Outputs {
    output: Option<Shared<Output>>,
    probes: Vec<ResolvedProbe>,
}

/// Spawns the particles, runs what belongs between that and the first step, and orders the systems.
fn start(
    scene: &Scene,
    source: &Source,
    mut sim: SimBuilder<'_>,
    outputs: Outputs,
) -> Result<Simulation, Vec<Problem>> {
    let Outputs { output, probes } = outputs;
    let mut world = spawn::spawn(&sim);
    let mut resources = Resources::with_shared(std::mem::take(&mut sim.shared));
    let held = BodySet::new(sim.held.take());
    for (item, step) in std::mem::take(&mut sim.setup) {
        let mut setup =
            Setup { world: &world, resources: &mut resources, held: &held, warnings: sim.warnings.get_mut() };
        step(&mut setup).map_err(|error| at_item(scene, item.as_ref(), error))?;
    }
    let schedule = Schedule::new(std::mem::take(&mut sim.systems), &sim.sub_cycled)
        .map_err(|e| vec![Problem::new(e.to_string())])?;
    world.declare(schedule.declared());
    resources.watch_by(world.watch());
    if let Some(output) = output {
        resources.of_mut(output).prepare(&sim.references).map_err(|problem| vec![*problem])?;
    }
    let sound_speeds = sim.bodies().iter().map(|body| body.material.sound_speed()).collect();
    let planes = sim.mirror_planes();
    let mirrored = [0, 1, 2].map(|axis| planes.iter().any(|plane| plane.axis == axis));
    let parts = SimulationParts {
        world,
        resources,
        schedule,
        sub_cycled: sim.sub_cycled,
        output,
        probes,
        source: source.clone(),
        warnings: sim.warnings.into_inner(),
        references: sim.references,
        sound_speeds,
        mirrored,
    };
    Ok(Simulation::new(parts, scene))
}

/// A fault of an item, if there is one, or of a body that it names by its path.
fn at_item(scene: &Scene, item: Option<&Item>, error: SetupError) -> Vec<Problem> {
    match (&error, item) {
        (SetupError::Parameter { field, .. }, _) if field.starts_with("bodies[") => at_scene(scene, error),
        (_, Some(item)) => error.into_problems(item),
        (_, None) => at_scene(scene, error),
    }
}

/// A fault that belongs to no item, such as one of a set-up step.
fn at_scene(scene: &Scene, error: SetupError) -> Vec<Problem> {
    match error {
        SetupError::Problems(problems) => problems,
        SetupError::Parameter { field, message, help } => {
            let place =
                if field.is_empty() && scene.bodies.len() == 1 { "bodies[0]".to_owned() } else { field };
            let problem = Problem::new(message).help(help);
            vec![Problem {
                at: if place.is_empty() { SourcePlace::Scene } else { SourcePlace::Path(place) },
                ..problem
            }]
        }
    }
}

/// Builds the plugins of bodies and of the scene, then the conditions; collects the problems of all. Returns
/// the items that have added recorders, one for each.
fn build_plugins(
    scene: &Scene,
    registry: &Registry,
    sim: &mut SimBuilder<'_>,
) -> Result<Vec<Item>, Vec<Problem>> {
    let mut problems = Vec::new();
    let mut recorder_items = Vec::new();
    let mut build = |kind, item: &Item, scope, sim: &mut SimBuilder<'_>| {
        (sim.scope, sim.own_body) = scope;
        sim.handed.by = Some(item.clone());
        match registry.build_plugin(kind, item, sim) {
            Ok(reference) => sim.cite(reference),
            Err(found) => problems.extend(found),
        }
        recorder_items.resize(sim.handed.count::<Box<dyn Recorder>>(), item.clone());
        sim.handed.by = None;
    };
    for of_materials in [true, false] {
        let due = |item: &&Item| registry.changes_materials(item) == of_materials;
        for (k, body) in scene.bodies.iter().enumerate() {
            for item in body.plugins.iter().filter(due) {
                build(EntryKind::Plugin, item, (BodySet::new([BodyId(k)]), Some(BodyId(k))), sim);
            }
        }
        for item in scene.plugins.iter().filter(due) {
            let own = |body: &&crate::scene::BodyDescription| {
                !body.plugins.iter().any(|other| other.name() == item.name())
            };
            let ids = scene.bodies.iter().enumerate().filter(|(_, body)| own(body)).map(|(k, _)| BodyId(k));
            build(EntryKind::Plugin, item, (BodySet::new(ids), None), sim);
        }
    }
    let all = BodySet::new((0..scene.bodies.len()).map(BodyId));
    for item in &scene.conditions {
        build(EntryKind::Condition, item, (all.clone(), None), sim);
    }
    if problems.is_empty() { Ok(recorder_items) } else { Err(problems) }
}

fn assemble(scene: &Scene, parsed: Vec<Parsed<'_>>, sim: &mut SimBuilder<'_>) -> Result<(), Vec<Problem>> {
    let mut groups: Vec<(&FormulationEntry, Vec<(BodyId, Box<dyn Any>)>)> = Vec::new();
    for (k, (entry, parameters)) in parsed.into_iter().enumerate() {
        match groups.iter_mut().find(|(known, _)| known.name == entry.name) {
            Some((_, bodies)) => bodies.push((BodyId(k), parameters)),
            None => groups.push((entry, vec![(BodyId(k), parameters)])),
        }
    }
    for (entry, bodies) in groups {
        let first = bodies[0].0;
        sim.own_body = None;
        sim.scope = BodySet::new(bodies.iter().map(|(id, _)| *id));
        sim.cite(entry.reference);
        let item = &scene.bodies[first.0].formulation;
        (entry.assemble)(bodies, sim).map_err(|error| at_item(scene, Some(item), error))?;
    }
    Ok(())
}
