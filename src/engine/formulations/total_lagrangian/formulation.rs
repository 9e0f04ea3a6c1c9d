//! The total-Lagrangian formulation: its parameters, its columns, and its two systems.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::internal_force;
use super::phase::PackedRows;
use super::set_up::SetUp;
use super::system::Deformation;
use crate::formulations::bonded::{BodySetUp, BondPairs, choose_support};
use crate::kernels::KernelName;
use crate::notation::{number, quantity};
use crate::pair::add_pair_systems;
use crate::plugin::{BodyKind, BodyPlan, Formulation, Offer, SetupError, SimBuilder};
use crate::scene::Dimension;
use crate::schedule::{Mode, Stage, Step, System};
use crate::solids::{AppliedLosses, CORRECTED_STRESS, SolidBodies};
use crate::symmetry::repeats_of;
use crate::world::{
    BodyId, ColumnSet, DeformationGradient, Force, Mass, PiolaStress, Position, ReferencePosition,
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
    /// In place of `support`, for irregular particles: the number of neighbours for which the support radius
    /// of each particle is chosen, half-way between the distances of the last of them and of the next.
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
        Offer::Sides,
    ];

    fn support(&self, body: &BodyPlan) -> Option<f64> {
        self.mean_support(body)
    }

    fn kernel(&self) -> Option<KernelName> {
        Some(self.kernel)
    }

    fn columns(columns: &mut ColumnSet) {
        columns
            .add::<SupportRadius>()
            .add::<DeformationGradient>()
            .add::<PiolaStress>()
            .add::<AppliedLosses>();
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
        let plane = sim.dimension() == Dimension::Two;
        let parts = bodies.into_iter().zip(solids.iter()).zip(repeats);
        let bodies = parts.map(|(((id, parameters), solid), repeats)| BodySetUp {
            id,
            kernel: parameters.kernel,
            support: parameters.support * sim.body(id).spacing,
            neighbors: parameters.neighbors,
            estimate: solid.estimate,
            hessian: solid.hessian,
            repeats,
            stays: true,
        });
        let first_lists = SetUp::of(phase, bodies.collect(), sim);
        sim.add_setup(move |setup| first_lists.run(setup));
        let state = solids.access();
        let system = System::new(Stage::Constitutive, DEFORMATION, Deformation::new(phase, plane, solids))
            .on_phases([phase])
            .reads_near::<Position>()
            .reads_near::<ReferencePosition>()
            .reads_near::<ReferenceVolume>()
            .reads_near::<Removed>()
            .reads_near::<SupportRadius>()
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
            .reads_near::<Position>()
            .touches(CORRECTED_STRESS, Mode::ReadsNear)
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
