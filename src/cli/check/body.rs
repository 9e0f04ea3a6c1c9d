//! The report of `check` on each body.

use meshless_engine::plugin::{BodyKind, Registry};
use meshless_engine::scene::{Dimension, Scene};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Mass, Mobility, PlasticStrain, Position};
use serde::Serialize;

use crate::cli::failure::CommandFailure;
use crate::cli::neighbors::NeighborCounts;

/// The properties of a body that determine cost and accuracy.
#[derive(Clone, Debug, Serialize)]
pub struct BodyReport {
    /// Name.
    pub name: String,
    /// Formulation.
    pub formulation: String,
    /// Kind of the body, from its formulation.
    #[serde(skip)]
    pub kind: Option<BodyKind>,
    /// Material.
    pub material: String,
    /// Number of particles.
    pub particles: usize,
    /// Spacing, m.
    pub spacing: f64,
    /// Mass, kg; in two dimensions kg/m.
    pub mass: f64,
    /// Speed of sound, m/s; none for walls.
    pub sound_speed: Option<f64>,
    /// Particles across the smallest side of the box around the body.
    pub across: f64,
    /// Whether its material is plastic.
    pub plastic: bool,
    /// Whether conditions hold or drive all of it along all axes.
    #[serde(skip)]
    pub driven: bool,
    /// Mean, smallest and largest number of neighbours, where they are counted.
    pub neighbours: Option<(f64, usize, usize)>,
    /// Names of the plugins of the scene and of the body.
    #[serde(skip)]
    pub plugins: Vec<String>,
}

impl BodyReport {
    /// Reports on all bodies.
    pub fn all(scene: &Scene, sim: &Simulation, registry: &Registry) -> Result<Vec<Self>, CommandFailure> {
        (0..scene.bodies.len()).map(|k| Self::of(k, scene, sim, registry)).collect()
    }

    fn of(k: usize, scene: &Scene, sim: &Simulation, registry: &Registry) -> Result<Self, CommandFailure> {
        let (body, described) = (&sim.world().bodies()[k], &scene.bodies[k]);
        let failed = |error: meshless_engine::world::MissingColumn| CommandFailure::Run(error.to_string());
        let (view, rows) = sim.world().body_view(BodyId(k));
        let mass: f64 = view.read::<Mass>().map_err(failed)?[rows.clone()].iter().map(|mass| mass.0).sum();
        let across = {
            let positions = view.read::<Position>().map_err(failed)?;
            let places = positions[rows.clone()].iter().map(|x| x.0);
            let axes = if scene.dimension == Dimension::Two { 2 } else { 3 };
            let side = |axis: usize| {
                let (low, high) =
                    places.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                        (low.min(x[axis]), high.max(x[axis]))
                    });
                (high - low) / body.spacing + 1.0
            };
            (0..axes).map(side).fold(f64::INFINITY, f64::min)
        };
        let count = NeighborCounts::count(sim, BodyId(k))?;
        let kind = registry.body_kind(described.formulation.name());
        let plugins = scene.plugins.iter().chain(&described.plugins);
        Ok(Self {
            name: body.name.clone(),
            formulation: described.formulation.name().to_owned(),
            kind,
            material: body.material.clone(),
            particles: body.rows.len(),
            spacing: body.spacing,
            mass,
            sound_speed: sim.sound_speeds().get(k).copied().flatten(),
            across,
            plastic: kind == Some(BodyKind::Solid)
                && view.read::<PlasticStrain>().is_ok()
                && has_plasticity(scene, &body.material),
            driven: is_driven(&view.read::<Mobility>().map_err(failed)?[rows], scene.dimension),
            neighbours: count.map(|count| (count.mean, count.min, count.max)),
            plugins: plugins.map(|item| item.name().to_owned()).collect(),
        })
    }
}

/// Whether all of these particles are constrained along all axes.
fn is_driven(mobility: &[Mobility], dimension: Dimension) -> bool {
    mobility.iter().all(|of| of.0.x == 0.0 && of.0.y == 0.0 && (dimension == Dimension::Two || of.0.z == 0.0))
}

/// Whether the material is plastic, from its text: columns do not tell, since all bodies of a formulation
/// share them.
fn has_plasticity(scene: &Scene, material: &str) -> bool {
    scene.materials.get(material).is_some_and(|item| {
        let text = item.text();
        ["hardening", "JohnsonCook", "Al6061T6", "Copper", "Steel"].iter().any(|name| text.contains(name))
    })
}
