//! The formulation as scenes name it: its parameters, their check, its columns and systems.

use schemars::JsonSchema;
use serde::Deserialize;

use super::columns::{UpdatedGradient, UpdatedMetric, UpdatedReference, UpdatedVolume};
use super::due::UpdateRule;
use super::force::UpdatedForce;
use super::force_change::{ChangeForces, ForceChange};
use super::phase::UpdatedRows;
use super::set_up::UpdatedSetUp;
use super::system::UpdatedSolids;
use super::update::Update;
use crate::formulations::bonded::{BodySetUp, BondPairs};
use crate::kernels::KernelName;
use crate::pair::add_present_pair_systems;
use crate::plugin::{BodyKind, BodyPlan, Formulation, Offer, SetupError, SimBuilder};
use crate::scene::Dimension;
use crate::schedule::{Mode, Stage, System};
use crate::solids::{AppliedLosses, CORRECTED_STRESS, SolidBodies, SolidBody, require_support};
use crate::symmetry::repeats_of;
use crate::world::{
    BodyId, Column, ColumnSet, Damage, DeformationGradient, Force, Mass, PhaseId, PiolaStress, Position,
    ReferencePosition, ReferenceVolume, Removed, SupportRadius, Velocity,
};

/// Updated-Lagrangian solid: neighbours, weights and corrections are recomputed while the body deforms.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct UpdatedLagrangian {
    /// Kernel.
    pub kernel: KernelName,
    /// Support radius over spacing.
    pub support: f64,
    /// When the present configuration becomes the reference.
    pub update: Update,
}

/// Support radius over spacing, where the scene gives none: a smoothing length of 1.2 spacings, as in the
/// paper.
const USUAL_SUPPORT: f64 = 2.4;

impl Default for UpdatedLagrangian {
    fn default() -> Self {
        Self { kernel: KernelName::CubicSpline, support: USUAL_SUPPORT, update: Update::Automatic }
    }
}

/// Label of the system that makes deformation gradient, stress and corrected stress, and updates the
/// reference.
const GRADIENT: &str = "updated_lagrangian_gradient";
/// Label of the system that makes the internal force.
const FORCE: &str = "updated_lagrangian_force";
/// Label of the system that goes on to the forces of a new reference.
const FORCE_CHANGE: &str = "updated_lagrangian_force_change";

impl Formulation for UpdatedLagrangian {
    const NAME: &'static str = "UpdatedLagrangian";
    const REFERENCE: &'static str = "updated-Lagrangian SPH: Y. Vidal, J. Bonet, A. Huerta, Int. J. Numer. Methods Engng. 69 (2007) 2687-2710";
    const KIND: BodyKind = BodyKind::Solid;
    const BYTES_PER_PARTICLE: usize = 3000;
    const OFFERS: &'static [Offer] = Offer::OF_LAGRANGIAN_SOLIDS;

    fn support(&self, body: &BodyPlan) -> Option<f64> {
        Some(self.support * body.spacing)
    }

    fn kernel(&self) -> Option<KernelName> {
        Some(self.kernel)
    }

    fn columns(columns: &mut ColumnSet) {
        columns
            .add::<SupportRadius>()
            .add::<DeformationGradient>()
            .add::<PiolaStress>()
            .add::<UpdatedReference>()
            .add::<UpdatedGradient>()
            .add::<UpdatedMetric>()
            .add::<UpdatedVolume>()
            .add::<AppliedLosses>();
    }

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let mut repeats = Vec::with_capacity(bodies.len());
        for (id, parameters) in &bodies {
            let body = sim.body(*id);
            parameters.check(body.spacing).map_err(|error| error.of_formulation(*id))?;
            let own = repeats_of(body, parameters.support * body.spacing, sim);
            repeats.push(own.map_err(|error| error.of_formulation(*id))?);
        }
        let ids: Vec<BodyId> = bodies.iter().map(|(id, _)| *id).collect();
        let phase = sim.body(ids[0]).phase;
        let plane = sim.dimension() == Dimension::Two;
        let solids = SolidBodies::new(&ids, sim)?;
        let state = solids.access();
        let parts = bodies.iter().zip(solids.iter()).zip(repeats);
        let first = parts.map(|(((id, parameters), solid), repeats)| BodySetUp {
            id: *id,
            kernel: parameters.kernel,
            support: parameters.support * sim.body(*id).spacing,
            neighbors: None,
            estimate: solid.estimate,
            hessian: solid.hessian,
            repeats,
            stays: matches!(parameters.update, Update::Automatic | Update::Never),
        });
        let first: Vec<BodySetUp> = first.collect();
        let can_fail = sim.columns(phase).get(Damage::NAME).is_some();
        let rule = |((id, own), solid): (&(BodyId, Self), &SolidBody)| {
            let spacing = sim.body(*id).spacing;
            let is_elastic = solid.law.initial_yield_stress().is_none() && !can_fail;
            UpdateRule { update: own.update, spacing, h: 0.5 * own.support * spacing, is_elastic }
        };
        let rules = bodies.iter().zip(solids.iter()).map(rule).collect();
        let change = sim.share(ForceChange::default());
        let system = UpdatedSolids::new(phase, plane, solids, rules, change);
        let first_lists = UpdatedSetUp::of(phase, first, system.is_stabilized(), sim);
        sim.add_system(gradient(phase, system).touches_all(state));
        let force = UpdatedForce { phase, plane, gravity: sim.gravity(), change };
        let force = System::new(Stage::Rates, FORCE, force).on_phases([phase]).reads::<Mass>();
        sim.add_system(
            force.reads_near::<Position>().touches(CORRECTED_STRESS, Mode::ReadsNear).writes::<Force>(),
        );
        let change = System::new(Stage::PostStep, FORCE_CHANGE, ChangeForces { phase, change });
        // Relaxation looks at the forces of the step.
        sim.add_system(change.on_phases([phase]).touches(Force::NAME, Mode::Adds).after_any("local_damping"));
        let has_pair_terms = add_present_pair_systems(sim, phase, BondPairs::<UpdatedRows>::of(phase))?;
        sim.add_setup(move |setup| first_lists.run(setup, has_pair_terms));
        Ok(())
    }
}

/// The system that computes deformation gradient and stress, and the new reference where an update is due.
fn gradient(phase: PhaseId, system: UpdatedSolids) -> System {
    System::new(Stage::Constitutive, GRADIENT, system)
        .on_phases([phase])
        .reads_near::<Position>()
        .reads_near::<ReferencePosition>()
        .reads_near::<ReferenceVolume>()
        .reads_near::<SupportRadius>()
        .writes::<SupportRadius>()
        .reads_near::<Removed>()
        .reads::<Velocity>()
        .reads::<Mass>()
        .reads_near::<UpdatedReference>()
        .reads_near::<UpdatedGradient>()
        .reads_near::<UpdatedVolume>()
        .writes::<UpdatedReference>()
        .writes::<UpdatedGradient>()
        .writes::<UpdatedMetric>()
        .writes::<UpdatedVolume>()
        .writes::<DeformationGradient>()
        .writes::<PiolaStress>()
}

impl UpdatedLagrangian {
    fn check(&self, spacing: f64) -> Result<(), SetupError> {
        require_support(self.support, USUAL_SUPPORT, spacing)?;
        match self.update {
            Update::Every(0) => Err(SetupError::parameter(
                "update",
                "`Every` must be at least 1 step, found 0",
                "use `Never` for a reference that stays",
            )),
            Update::Adaptive { change } if !(change > 0.0 && change <= 1.0) => Err(SetupError::parameter(
                "update",
                format!("`change` must be above 0 and at most 1, found {change}"),
                "1 is usual",
            )),
            _ => Ok(()),
        }
    }
}
