//! Set-up before the first step: the columns of the reference, and its lists.

use glam::{DMat3, DVec3};

use super::columns::{UpdatedGradient, UpdatedMetric, UpdatedReference, UpdatedVolume};
use super::control::Control;
use super::lists::ReferenceLists;
use super::phase::UpdatedRows;
use super::reference::RenewError;
use crate::formulations::bonded::{BodySetUp, Bonds, Cracks, HeldParticles, HessianRows, held_of};
use crate::linalg::Sym3;
use crate::plugin::{Setup, SetupError, SimBuilder};
use crate::removal::LeavingParticles;
use crate::solids::StepEstimate;
use crate::symmetry::Ghosts;
use crate::world::{
    DeformationGradient, MissingColumn, PhaseId, ReferencePosition, ReferenceVolume, SupportRadius, World,
};

/// The bodies of a phase before the first step.
pub(super) struct UpdatedSetUp {
    phase: PhaseId,
    bodies: Vec<BodySetUp>,
    held: HeldParticles,
    /// Of every body: whether stabilizers act on it.
    is_stabilized: Vec<bool>,
}

impl UpdatedSetUp {
    /// That of the bodies of a phase.
    pub fn of(
        phase: PhaseId,
        bodies: Vec<BodySetUp>,
        is_stabilized: Vec<bool>,
        sim: &SimBuilder<'_>,
    ) -> Self {
        let held = held_of(&bodies, sim);
        Self { phase, bodies, held, is_stabilized }
    }

    /// Fills the columns of the reference with those of the start, and makes its lists.
    pub fn run(self, setup: &mut Setup<'_>, has_pair_terms: bool) -> Result<(), SetupError> {
        setup.warnings.extend(self.held.warnings.iter().cloned());
        self.fill_columns(setup.world).map_err(|error| SetupError::internal(&error))?;
        let phase = self.phase;
        let estimates: Vec<StepEstimate> = self.bodies.iter().map(|body| body.estimate).collect();
        let mut rows = UpdatedRows { has_pair_terms, ..self.rows(setup.world) };
        rows.renew(setup.world, phase, &estimates, &[]).map_err(|RenewError { body, error }| {
            let help = "use a larger `support`, or more particles across the body";
            SetupError::parameter(format!("bodies[{}].formulation", body.0), error.to_string(), help)
        })?;
        rows.take_gradients(setup.world, phase, &[]).map_err(|error| SetupError::internal(&error))?;
        rows.warn_of_released_at_start(setup);
        setup.resources.insert_solid(phase, rows);
        setup.resources.insert_of(phase, LeavingParticles::default());
        Ok(())
    }

    fn fill_columns(&self, world: &World) -> Result<(), MissingColumn> {
        let view = world.phase(self.phase);
        let original = view.read::<ReferencePosition>()?;
        let mut reference = view.write::<UpdatedReference>()?;
        reference.iter_mut().zip(original.iter()).for_each(|(now, start)| now.0 = start.0);
        let start = view.read::<ReferenceVolume>()?;
        let mut volume = view.write::<UpdatedVolume>()?;
        volume.iter_mut().zip(start.iter()).for_each(|(now, start)| now.0 = start.0);
        view.write::<UpdatedGradient>()?.fill(UpdatedGradient(DMat3::IDENTITY));
        view.write::<UpdatedMetric>()?.fill(UpdatedMetric(Sym3::IDENTITY));
        view.write::<DeformationGradient>()?.fill(DeformationGradient(DMat3::IDENTITY));
        let mut support = view.write::<SupportRadius>()?;
        for body in &self.bodies {
            support[world.body(body.id).rows.clone()].fill(SupportRadius(body.support));
        }
        Ok(())
    }

    /// The packed rows, without lists.
    fn rows(self, world: &World) -> UpdatedRows {
        let Self { phase, bodies, mut held, is_stabilized } = self;
        let (count, dimension) = (world.phase(phase).len(), world.dimension().count());
        let carried = std::mem::take(&mut held.carried);
        let terms = bodies.iter().map(|body| (world.body(body.id).rows.clone(), body.hessian));
        UpdatedRows {
            bonds: Bonds { carried, ..Bonds::default() },
            held,
            ghosts: Ghosts::default(),
            origin: DVec3::ZERO,
            sites: Vec::new(),
            pair_sites: Vec::new(),
            has_pair_terms: false,
            gradient: Vec::new(),
            ellipsoids: Vec::new(),
            volume: Vec::new(),
            stresses: Vec::new(),
            self_force: vec![DVec3::ZERO; count],
            frames: Vec::with_capacity(bodies.len()),
            control: Control::of(is_stabilized),
            cracks: Cracks::default(),
            hessian: HessianRows::new(terms),
            kernels: bodies.iter().map(|body| body.kernel(dimension)).collect(),
            stable_step: Vec::with_capacity(bodies.len()),
            follows: Vec::with_capacity(bodies.len()),
            released_at_start: Vec::new(),
            lists: ReferenceLists::default(),
            force: Vec::new(),
            has_force: false,
            repeats: bodies.into_iter().map(|body| body.repeats).collect(),
        }
    }
}
