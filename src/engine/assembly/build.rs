//! Scene to simulation: materials, particles, plugins, systems, columns.

use std::any::Any;
use std::path::Path;

use glam::DVec3;

use super::memory;
use super::names;
use super::options::BuildOptions;
use super::overlap;
use super::placement;
use super::plausibility;
use super::spawn;
use super::{clamps, supports};
use crate::materials::{Law, Material};
use crate::plugin::{
    BodyKind, BodyPlan, Formulation, FormulationEntry, Kind, Registry, Setup, SetupError, SimBuilder,
};
use crate::record::{OutputPlan, Recorder};
use crate::rigid::Rigid;
use crate::scene::{Body, Domain, Item, Place, Problem, Scene, SceneError, Source};
use crate::schedule::{Resources, Schedule};
use crate::shapes::{self, Site};
use crate::simulation::{Simulation, SimulationParts};
use crate::world::{BodyId, BodySet, ColumnSet, PhaseId};

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

type Parsed<'r> = (&'r FormulationEntry, Box<dyn Any>);

fn build_in(
    scene: &Scene,
    source: &Source,
    registry: &Registry,
    options: &BuildOptions,
) -> Result<Simulation, Vec<Problem>> {
    let misspelt = names::problems(scene, registry);
    if !misspelt.is_empty() {
        return Err(misspelt);
    }
    let (mut bodies, phases, parsed) = place_bodies(scene, source, registry)?;
    let misplaced = placement::problems(&bodies, scene);
    if !misplaced.is_empty() {
        return Err(misplaced);
    }
    crate::formulations::fluid::estimate_sound_speeds(&mut bodies, scene)?;
    let overlaps = overlap::problems(&bodies);
    if !overlaps.is_empty() {
        return Err(overlaps);
    }
    let mut sim = SimBuilder::new(scene, source.folder(), bodies, phases);
    clamps::warn(scene, registry, &mut sim);
    supports::place(scene, registry, &mut sim);
    plausibility::warn(&mut sim);
    let recorder_items = build_plugins(scene, registry, &mut sim)?;
    crate::formulations::fluid::damp_ringing(&mut sim);
    crate::solids::add_fields(&mut sim);
    assemble(scene, parsed, &mut sim)?;
    crate::formulations::fluid::add_systems(&mut sim).map_err(|error| at_scene(scene, error))?;
    crate::removal::add_system(&mut sim);
    for contact in &scene.contacts {
        sim.cite(registry.reference(Kind::ContactLaw, contact.law.name()));
    }
    crate::contact::add_systems(&mut sim, &|item, pair| registry.build_contact_law(item, pair))?;
    crate::integrate::add_systems(&mut sim);
    crate::record::watchdog::add_system(&mut sim);
    let plan = OutputPlan::resolve(&mut sim, &recorder_items)?;
    let probes = plan.probes();
    let output = options.output.as_ref().map(|options| plan.attach(&mut sim, source, options));
    sim.refuse_leftovers()?;
    let world = spawn::spawn(&sim);
    let mut resources = Resources::default();
    let held = BodySet::new(sim.held.take());
    for step in std::mem::take(&mut sim.setup) {
        let mut setup =
            Setup { world: &world, resources: &mut resources, held: &held, warnings: &mut sim.warnings };
        step(&mut setup).map_err(|error| at_scene(scene, error))?;
    }
    let schedule = Schedule::new(std::mem::take(&mut sim.systems), &sim.sub_cycled)
        .map_err(|e| vec![Problem::new(e.to_string())])?;
    if let Some(output) = &output {
        output.lock().prepare(&sim.references).map_err(|problem| vec![*problem])?;
    }
    let sound_speeds = sim.bodies().iter().map(|body| body.material.sound_speed()).collect();
    let parts = SimulationParts {
        world,
        resources,
        schedule,
        sub_cycled: sim.sub_cycled,
        output,
        probes,
        source: source.clone(),
        warnings: sim.warnings,
        references: sim.references,
        sound_speeds,
    };
    Ok(Simulation::new(parts, scene))
}

/// A fault that belongs to no item, such as one of a set-up step.
fn at_scene(scene: &Scene, error: SetupError) -> Vec<Problem> {
    match error {
        SetupError::Problems(problems) => problems,
        SetupError::Parameter { field, message, help } => {
            let place =
                if field.is_empty() && scene.bodies.len() == 1 { "bodies[0]".to_owned() } else { field };
            let problem = Problem::new(message).help(help);
            vec![Problem { at: if place.is_empty() { Place::Scene } else { Place::Path(place) }, ..problem }]
        }
    }
}

type Placed<'r> = (Vec<BodyPlan>, Vec<(&'static str, ColumnSet)>, Vec<Parsed<'r>>);

fn place_bodies<'r>(
    scene: &Scene,
    source: &Source,
    registry: &'r Registry,
) -> Result<Placed<'r>, Vec<Problem>> {
    let mut problems = Vec::new();
    let mut materials = Vec::new();
    for (name, item) in &scene.materials {
        match registry.build_material(item) {
            Ok(material) => materials.push((name.as_str(), material)),
            Err(found) => problems.extend(found),
        }
    }
    let folder = source.folder();
    let mut room = memory::particle_limit();
    let mut bodies: Vec<BodyPlan> = Vec::new();
    let mut phases: Vec<(&'static str, ColumnSet)> = Vec::new();
    let mut lens: Vec<usize> = Vec::new();
    let mut parsed = Vec::new();
    for (k, body) in scene.bodies.iter().enumerate() {
        let formulation = match parse_formulation(registry, &body.formulation) {
            Ok(formulation) => formulation,
            Err(found) => {
                problems.extend(found);
                continue;
            }
        };
        let filled = match endless_tool(body, formulation.0.name, scene, folder) {
            Some(sites) => Ok(sites),
            None => {
                let fill =
                    if formulation.0.kind == BodyKind::Boundary { shapes::fill_wall } else { shapes::fill };
                fill(&body.shape, body.lattice, body.spacing, scene.dimension, folder, room)
            }
        };
        let region = body.shape.region(scene.dimension, folder, "shape");
        let (sites, bounds) = match (filled, region) {
            (Ok(sites), Ok(region)) => (sites, region.bounds()),
            (Ok(sites), Err(_)) => {
                let bounds = shapes::Aabb::around(sites.iter().map(|site| site.position));
                (sites, bounds)
            }
            (Err(error), _) => {
                let path = format!("bodies[{k}].{}", error.path);
                problems.push(Problem::at_path(path, error.kind.to_string()).helps(error.kind.help()));
                continue;
            }
        };
        let material = match materials.iter().find(|(name, _)| *name == body.material) {
            Some((_, material)) => material.clone(),
            None if scene.materials.contains_key(&body.material) => continue,
            None => Material::nothing(),
        };
        room = room.saturating_sub(sites.len());
        let name = formulation.0.name;
        let phase = phases.iter().position(|(known, _)| *known == name).unwrap_or_else(|| {
            let mut columns = ColumnSet::default();
            spawn::standard_columns(&mut columns);
            (formulation.0.columns)(&mut columns);
            phases.push((name, columns));
            lens.push(0);
            phases.len() - 1
        });
        if let Law::Solid(law) = &material.law {
            law.state(&mut phases[phase].1);
        }
        let start = lens[phase];
        lens[phase] += sites.len();
        let mut plan = BodyPlan {
            id: BodyId(k),
            name: body.name.clone(),
            phase: PhaseId(phase),
            formulation: name,
            kind: formulation.0.kind,
            offers: formulation.0.offers,
            support: None,
            rows: start..lens[phase],
            spacing: body.spacing,
            material_name: body.material.clone(),
            material,
            sites,
            carried: Vec::new(),
            hidden: Vec::new(),
            bounds,
            velocity: body.velocity,
        };
        plan.support = (formulation.0.support)(&*formulation.1, &plan);
        bodies.push(plan);
        parsed.push(formulation);
    }
    if problems.is_empty() { Ok((bodies, phases, parsed)) } else { Err(problems) }
}

/// The one particle, just behind the surface, that stands for a rigid body without end: a half-space that is a tool.
fn endless_tool(body: &Body, formulation: &str, scene: &Scene, folder: &Path) -> Option<Vec<Site>> {
    if formulation != Rigid::NAME || !(body.spacing > 0.0 && body.spacing.is_finite()) {
        return None;
    }
    let region = body.shape.region(scene.dimension, folder, "shape").ok()?;
    if region.bounds().is_bounded() {
        return None;
    }
    let surface = body.shape.surface(scene.dimension, folder, "shape").ok()?;
    let middle = |domain: &Domain| 0.5 * (domain.min.0 + domain.max.0);
    let nearest = surface.closest(scene.domain.as_ref().map_or(DVec3::ZERO, middle));
    let position = nearest.point - 0.5 * body.spacing * nearest.normal;
    Some(vec![Site { position, volume: body.spacing.powi(scene.dimension.count() as i32) }])
}

fn parse_formulation<'r>(registry: &'r Registry, item: &Item) -> Result<Parsed<'r>, Vec<Problem>> {
    let entry = registry.find_formulation(item)?;
    Ok((entry, (entry.parse)(item)?))
}

/// Builds the plugins of bodies and of the scene, then the conditions; collects what is wrong with any of them.
/// Returns the items that have added recorders, one for each.
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
                build(Kind::Plugin, item, (BodySet::new([BodyId(k)]), Some(BodyId(k))), sim);
            }
        }
        for item in scene.plugins.iter().filter(due) {
            let own =
                |body: &&crate::scene::Body| !body.plugins.iter().any(|other| other.name() == item.name());
            let ids = scene.bodies.iter().enumerate().filter(|(_, body)| own(body)).map(|(k, _)| BodyId(k));
            build(Kind::Plugin, item, (BodySet::new(ids), None), sim);
        }
    }
    let all = BodySet::new((0..scene.bodies.len()).map(BodyId));
    for item in &scene.conditions {
        build(Kind::Condition, item, (all.clone(), None), sim);
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
        (entry.assemble)(bodies, sim).map_err(|error| match error {
            SetupError::Parameter { ref field, .. } if field.starts_with("bodies[") => at_scene(scene, error),
            error => error.into_problems(item),
        })?;
    }
    Ok(())
}
