//! Bodies of a scene: material, formulation, particles, and the rows of the phase that they get.

use std::any::Any;
use std::path::Path;

use glam::DVec3;

use super::{memory, spawn};
use crate::materials::{Law, Material};
use crate::plugin::{BodyKind, BodyPlan, Distances, Formulation, FormulationEntry, Registry};
use crate::rigid::Rigid;
use crate::scene::{BodyDescription, Domain, Item, Problem, Scene, Source};
use crate::shapes::{self, Aabb, Filling, Site};
use crate::world::{BodyId, ColumnSet, PhaseId};

/// A formulation with the parameters that a scene gives it.
pub(super) type Parsed<'r> = (&'r FormulationEntry, Box<dyn Any>);

/// The bodies of a scene, in its order.
#[derive(Default)]
pub(super) struct Placed<'r> {
    pub bodies: Vec<BodyPlan>,
    /// Formulation and columns of each phase.
    pub phases: Vec<(&'static str, ColumnSet)>,
    /// Formulation of each body.
    pub formulations: Vec<Parsed<'r>>,
    /// Number of particles of each phase.
    lens: Vec<usize>,
}

/// Places all bodies; collects the problems of all.
pub(super) fn place_bodies<'r>(
    scene: &Scene,
    source: &Source,
    registry: &'r Registry,
) -> Result<Placed<'r>, Vec<Problem>> {
    let (mut problems, mut materials) = (Vec::new(), Vec::new());
    for (name, item) in &scene.materials {
        match registry.build_material(item) {
            Ok(material) => materials.push((name.as_str(), material)),
            Err(found) => problems.extend(found),
        }
    }
    let mut memory_left = memory::free();
    let beside_fluid = scene.bodies.iter().any(|body| is_fluid(body, registry));
    let mut placed = Placed::default();
    for (k, body) in scene.bodies.iter().enumerate() {
        let place = || {
            let formulation = parse_formulation(registry, &body.formulation)?;
            let filled = fill(body, formulation.0, (scene, source.folder()), beside_fluid, memory_left);
            let (sites, bounds) = filled.map_err(|error| {
                let path = format!("bodies[{k}].{}", error.path);
                vec![Problem::at_path(path, error.message()).helps(error.kind.help())]
            })?;
            Ok((formulation, sites, bounds))
        };
        let parts = place().map_err(|found: Vec<Problem>| problems.extend(found));
        let Ok((formulation, sites, bounds)) = parts else { continue };
        let material = match materials.iter().find(|(name, _)| *name == body.material) {
            // Walls have no material, whatever the name: no mass, which gravity would work on.
            _ if formulation.0.kind == BodyKind::Boundary => Material::nothing(),
            Some((_, material)) => material.clone(),
            None if scene.materials.contains_key(&body.material) => continue,
            None => Material::nothing(),
        };
        memory_left = memory_left.saturating_sub(sites.len() * formulation.0.bytes_per_particle);
        let plan = BodyPlan {
            id: BodyId(k),
            name: body.name.clone(),
            phase: PhaseId(0),
            formulation: formulation.0.name,
            kind: formulation.0.kind,
            offers: formulation.0.offers,
            support: None,
            kernel: None,
            distances: Distances::Reference,
            rows: 0..sites.len(),
            spacing: body.spacing,
            material_name: body.material.clone(),
            material,
            sites,
            carried: Vec::new(),
            hidden: Vec::new(),
            sides: Vec::new(),
            bounds,
            velocity: body.velocity,
        };
        placed.push(plan, formulation);
    }
    if problems.is_empty() { Ok(placed) } else { Err(problems) }
}

impl<'r> Placed<'r> {
    /// Adds a body to the phase of its formulation, behind the rows that are there.
    fn push(&mut self, mut plan: BodyPlan, formulation: Parsed<'r>) {
        let Self { phases, lens, .. } = self;
        let phase = phases.iter().position(|(known, _)| *known == plan.formulation).unwrap_or_else(|| {
            let mut columns = ColumnSet::default();
            spawn::standard_columns(&mut columns);
            (formulation.0.columns)(&mut columns);
            phases.push((plan.formulation, columns));
            lens.push(0);
            phases.len() - 1
        });
        if let Law::Solid(law) = &plan.material.law {
            law.state(&mut phases[phase].1);
        }
        plan.phase = PhaseId(phase);
        plan.rows = lens[phase]..lens[phase] + plan.sites.len();
        lens[phase] = plan.rows.end;
        plan.support = (formulation.0.support)(&*formulation.1, &plan);
        plan.kernel = (formulation.0.kernel)(&*formulation.1);
        plan.distances = (formulation.0.distances)(&*formulation.1, &plan);
        self.bodies.push(plan);
        self.formulations.push(formulation);
    }
}

/// The particles of a body, and the box around its shape.
fn fill(
    body: &BodyDescription,
    formulation: &FormulationEntry,
    (scene, folder): (&Scene, &Path),
    beside_fluid: bool,
    memory_left: usize,
) -> Result<(Vec<Site>, Aabb), shapes::FillError> {
    let sites = match endless_tool(body, formulation.name, scene, folder) {
        Some(sites) => sites,
        None => {
            let filling = Filling {
                lattice: body.lattice,
                spacing: body.spacing,
                dimension: scene.dimension,
                folder,
                limit: memory_left / formulation.bytes_per_particle,
                is_wall: formulation.kind == BodyKind::Boundary,
            };
            let filling = if beside_fluid { filling.beside_fluid(&body.shape) } else { filling };
            shapes::fill(&body.shape, filling)?
        }
    };
    let bounds = match body.shape.region(scene.dimension, folder, "shape") {
        Ok(region) => region.bounds(),
        Err(_) => Aabb::around(sites.iter().map(|site| site.position)),
    };
    Ok((sites, bounds))
}

/// The particles, just behind the surface, that represent an unbounded rigid body: a half-space that is a
/// tool. They are the corners of a square or a cube, so that forces on them can have any torque.
fn endless_tool(
    body: &BodyDescription,
    formulation: &str,
    scene: &Scene,
    folder: &Path,
) -> Option<Vec<Site>> {
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
    let middle = nearest.point - body.spacing * nearest.normal;
    let axes = scene.dimension.count();
    let volume = body.spacing.powi(axes as i32);
    let corner = |k: usize| {
        let side = |axis: usize| if axis >= axes { 0.0 } else { (k >> axis & 1) as f64 - 0.5 };
        Site { position: middle + body.spacing * DVec3::new(side(0), side(1), side(2)), volume }
    };
    Some((0..1 << axes).map(corner).collect())
}

fn is_fluid(body: &BodyDescription, registry: &Registry) -> bool {
    registry.find_formulation(&body.formulation).is_ok_and(|entry| entry.kind == BodyKind::Fluid)
}

fn parse_formulation<'r>(registry: &'r Registry, item: &Item) -> Result<Parsed<'r>, Vec<Problem>> {
    let entry = registry.find_formulation(item)?;
    Ok((entry, (entry.parse)(item)?))
}
