//! The total-Lagrangian formulation: its parameters, its columns, and its two systems.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::bonds::{BodyBonds, Bonds};
use super::cracks::Cracks;
use super::held::Held;
use super::hessian::HessianRows;
use super::internal_force;
use super::pairs::{BodyKernel, BondPairs};
use super::phase::PackedRows;
use super::rows::Site;
use super::support::choose_support;
use super::system::Deformation;
use crate::kernels::{Kernel, KernelName};
use crate::neighbors::NeighborSearch;
use crate::notation::{number, quantity};
use crate::pair::add_pair_systems;
use crate::plugin::{BodyKind, BodyPlan, Formulation, Offer, Setup, SetupError, SimBuilder};
use crate::scene::Dimension;
use crate::schedule::{Mode, Stage, Step, System};
use crate::solids::{CorrectedStress, HessianDifference, SolidBodies, StepEstimate};
use crate::symmetry::{Ghosts, Repeat, repeats_of};
use crate::world::{
    BodyId, ColumnSet, DeformationGradient, Force, Mass, PhaseId, PiolaStress, Position, ReferencePosition,
    ReferenceVolume, Removed, SupportRadius, Velocity,
};

/// Total-Lagrangian solid: neighbours, weights and corrections stay those of the reference configuration.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TotalLagrangian {
    /// Kernel.
    pub kernel: KernelName,
    /// Support radius over spacing.
    pub support: f64,
    /// In place of `support`, for irregular particles: the number of neighbours for which the support radius of each
    /// particle is chosen, half-way between the distances of the last of them and of the next.
    pub neighbors: Option<u32>,
}

/// Support radius over spacing, where the scene gives none.
const USUAL_SUPPORT: f64 = 2.41;

impl Default for TotalLagrangian {
    fn default() -> Self {
        Self { kernel: KernelName::Spiky, support: USUAL_SUPPORT, neighbors: None }
    }
}

/// Label of the system that makes deformation gradient, stress and corrected stress.
const DEFORMATION: &str = "total_lagrangian_deformation";
/// Label of the system that makes the internal force.
const INTERNAL_FORCE: &str = "total_lagrangian_force";

impl Formulation for TotalLagrangian {
    const NAME: &'static str = "TotalLagrangian";
    const REFERENCE: &'static str =
        "total-Lagrangian SPH: G. C. Ganzenmueller, Comput. Methods Appl. Mech. Engrg. 286 (2015) 87-106";
    const KIND: BodyKind = BodyKind::Solid;
    const OFFERS: &'static [Offer] = &[
        Offer::PairTerms,
        Offer::FoldedTerms,
        Offer::HessianDifferences,
        Offer::MirrorImages,
        Offer::Contact,
        Offer::SelfContact,
        Offer::DeformedContact,
        Offer::Supports,
    ];

    fn support(&self, body: &BodyPlan) -> Option<f64> {
        self.mean_support(body)
    }

    fn columns(columns: &mut ColumnSet) {
        columns.add::<SupportRadius>().add::<DeformationGradient>().add::<PiolaStress>();
    }

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        for (id, parameters) in &bodies {
            parameters.check(sim.body(*id)).map_err(|error| error.of_formulation(*id))?;
        }
        let phase = sim.body(bodies[0].0).phase;
        let repeats_of = |(id, parameters): &(BodyId, Self)| {
            let body = sim.body(*id);
            let repeats = repeats_of(body, parameters.support * body.spacing, sim);
            repeats.map_err(|error| error.of_formulation(*id))
        };
        let repeats = bodies.iter().map(repeats_of).collect::<Result<Vec<_>, _>>()?;
        for ((id, parameters), repeats) in bodies.iter().zip(&repeats) {
            if parameters.neighbors.is_some() && !repeats.is_empty() {
                let message = "neighbours cannot be counted across a symmetry plane or a periodic side";
                let error = SetupError::parameter("neighbors", message, "give a `support` instead");
                return Err(error.of_formulation(*id));
            }
        }
        let ids: Vec<BodyId> = bodies.iter().map(|(id, _)| *id).collect();
        let solids = SolidBodies::new(&ids, sim)?;
        let estimates: Vec<StepEstimate> = solids.iter().map(|body| body.estimate).collect();
        let plane = sim.dimension() == Dimension::Two;
        let terms: Vec<Option<HessianDifference>> = solids.iter().map(|body| body.hessian).collect();
        let held = Held::of(&ids, sim);
        sim.add_setup(move |setup| set_up(&bodies, &estimates, &terms, &repeats, (phase, held), setup));
        let state = solids.access();
        let deformation = Deformation::new(phase, plane, solids);
        let system = System::new(Stage::Constitutive, DEFORMATION, deformation)
            .on_phases([phase])
            .reads::<Position>()
            .reads::<ReferencePosition>()
            .reads::<ReferenceVolume>()
            .reads::<Removed>()
            .reads::<Velocity>()
            .reads::<Mass>()
            .touches_all(state);
        sim.add_system(system);
        let gravity = sim.gravity();
        sim.add_system(
            System::new(Stage::Rates, INTERNAL_FORCE, move |step: &mut Step<'_>| {
                internal_force::run(step, phase, gravity, plane)
            })
            .on_phases([phase])
            .reads::<Mass>()
            .touches("corrected_stress", Mode::Reads)
            .writes::<Force>(),
        );
        add_pair_systems(sim, phase, BondPairs::<PackedRows>::of(phase))?;
        Ok(())
    }
}

impl TotalLagrangian {
    /// Mean support radius of the particles of a body, m.
    fn mean_support(&self, body: &BodyPlan) -> Option<f64> {
        let usual = self.support * body.spacing;
        let Some(neighbors) = self.neighbors.filter(|n| body.sites.len() > *n as usize + 1) else {
            return Some(usual);
        };
        let position: Vec<DVec3> = body.sites.iter().map(|site| site.position).collect();
        let mut support = vec![0.0; position.len()];
        choose_support(&position, usual, neighbors as usize, &mut support).ok()?;
        Some(support.iter().sum::<f64>() / support.len() as f64)
    }

    fn check(&self, body: &BodyPlan) -> Result<(), SetupError> {
        if let Some(neighbors) = self.neighbors {
            return self.check_neighbors(neighbors, body);
        }
        let spacing = body.spacing;
        let fewest = 1.5;
        if self.support.is_finite() && self.support >= fewest && self.support <= 10.0 {
            return Ok(());
        }
        Err(SetupError::parameter(
            "support",
            format!(
                "the support radius must be {fewest} to 10 spacings, found {} ({})",
                number(self.support),
                quantity(self.support * spacing, "m")
            ),
            format!("{USUAL_SUPPORT} spacings are usual"),
        ))
    }

    fn check_neighbors(&self, neighbors: u32, body: &BodyPlan) -> Result<(), SetupError> {
        let fault = |message: String, help: &str| Err(SetupError::parameter("neighbors", message, help));
        if self.support != USUAL_SUPPORT {
            return fault(
                "`support` and `neighbors` both set the support radius".to_owned(),
                "give one of them",
            );
        }
        if !(4..=400).contains(&neighbors) {
            let message = format!("`neighbors` must be 4 to 400, found {neighbors}");
            return fault(message, "12 in two and 30 in three dimensions are usual");
        }
        if body.sites.len() < neighbors as usize + 2 {
            let message = format!("body `{}` has only {} particles", body.name, body.sites.len());
            return fault(message, "use more particles, or fewer neighbours");
        }
        Ok(())
    }
}

fn set_up(
    bodies: &[(BodyId, TotalLagrangian)],
    estimates: &[StepEstimate],
    terms: &[Option<HessianDifference>],
    repeats: &[Vec<Repeat>],
    (phase, held): (PhaseId, Held),
    setup: &mut Setup<'_>,
) -> Result<(), SetupError> {
    let view = setup.world.phase(phase);
    let missing = |error: crate::world::MissingColumn| SetupError::internal(&error);
    let reference = view.read::<ReferencePosition>().map_err(missing)?;
    let volume = view.read::<ReferenceVolume>().map_err(missing)?;
    let mut support = view.write::<SupportRadius>().map_err(missing)?;
    let mut gradient = view.write::<DeformationGradient>().map_err(missing)?;
    gradient.fill(DeformationGradient(glam::DMat3::IDENTITY));
    for (id, parameters) in bodies {
        let body = setup.world.body(*id);
        let usual = parameters.support * body.spacing;
        let support = &mut support[body.rows.clone()];
        match parameters.neighbors {
            None => support.fill(SupportRadius(usual)),
            Some(neighbors) => {
                let position = bytemuck::cast_slice(&reference[body.rows.clone()]);
                choose_support(position, usual, neighbors as usize, bytemuck::cast_slice_mut(support))
                    .map_err(|error| SetupError::internal(&error))?;
            }
        }
    }
    let position: &[DVec3] = bytemuck::cast_slice(&reference);
    let volume: &[f64] = bytemuck::cast_slice(&volume);
    let support: &[f64] = bytemuck::cast_slice(&support);
    let dimension = setup.world.dimension().count();
    let mut bonds = Bonds::default();
    let mut ghosts = Ghosts::new(view.len());
    let mut search = NeighborSearch::default();
    let mut stable_step = Vec::new();
    let mut kernels = Vec::new();
    for (((id, parameters), estimate), repeats) in bodies.iter().zip(estimates).zip(repeats) {
        let body = setup.world.body(*id);
        let Some(kernel) = Kernel::new(parameters.kernel, dimension) else {
            unreachable!("every kernel has a two- and a three-dimensional form");
        };
        let uniform = parameters.neighbors.is_none().then_some(parameters.support * body.spacing);
        kernels.push(BodyKernel { body: *id, kernel, support: uniform });
        let rows = body.rows.clone();
        let ghost_rows = ghosts.add(rows.clone(), position, parameters.support * body.spacing, repeats);
        let hidden = held.hidden_of(*id);
        let body_bonds = BodyBonds {
            rows: rows.clone(),
            position,
            volume,
            support,
            ellipsoids: None,
            kernel,
            ghosts: &ghosts,
            ghost_rows,
            hidden,
        };
        bonds.append(&body_bonds, &mut search).map_err(|error| {
            let help = "use a larger `support`, or more particles across the body";
            SetupError::parameter(format!("bodies[{}].formulation", id.0), error.to_string(), help)
        })?;
        let free = bonds.free.iter().filter(|&&row| rows.contains(&(row as usize))).count() - hidden.len();
        if free > 0 {
            let text = format!(
                "{free} particles of body `{}` have too few neighbours and carry no stress",
                body.name
            );
            setup.warnings.push(text);
        }
        stable_step.push(bonds.stable_step(rows, dimension, estimate, support, None));
    }
    let stresses = vec![CorrectedStress::default(); view.len() + ghosts.len()];
    let self_force = vec![DVec3::ZERO; view.len()];
    let (low, high) = position
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
    let origin = 0.5 * (low + high);
    let mut sites = vec![Site::default(); view.len() + ghosts.len()];
    for (site, (x, v)) in sites.iter_mut().zip(position.iter().zip(volume)) {
        *site = Site::new(*x - origin, DVec3::ZERO, *v);
    }
    bonds.carried = held.carried;
    let terms = bodies.iter().zip(terms).map(|((id, _), term)| (setup.world.body(*id).rows.clone(), *term));
    let mut hessian = HessianRows::new(terms);
    hessian.resize(view.len(), ghosts.len());
    let mut packed = PackedRows {
        bonds,
        ghosts,
        origin,
        sites,
        stresses,
        self_force,
        frames: Vec::with_capacity(bodies.len()),
        cracks: Cracks::default(),
        hessian,
        kernels,
        stable_step,
    };
    packed.fill_ghost_sites();
    setup.resources.insert_solid(phase, packed);
    Ok(())
}
