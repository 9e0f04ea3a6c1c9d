//! The reference: neighbours, weights and moments at the positions of the last update.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::columns::{UpdatedGradient, UpdatedMetric, UpdatedReference, UpdatedVolume};
use super::parameters::UpdatedLagrangian;
use super::phase::UpdatedRows;
use crate::formulations::total_lagrangian::{
    BodyBonds, BodyKernel, BondError, Bonds, Cracks, Ellipsoid, Ellipsoids, Held, HessianRows, Site,
};
use crate::kernels::Kernel;
use crate::linalg::Sym3;
use crate::neighbors::NeighborSearch;
use crate::plugin::{Setup, SetupError};
use crate::schedule::StepError;
use crate::solids::{CorrectedStress, HessianDifference, StepEstimate};
use crate::symmetry::{Ghosts, Repeat};
use crate::world::{
    BodyId, Damage, DeformationGradient, MissingColumn, PhaseId, ReferencePosition, ReferenceVolume,
    SupportRadius, World,
};

/// Fills the columns of the reference with those of the start, and makes its lists.
pub(super) fn set_up(
    bodies: &[(BodyId, UpdatedLagrangian)],
    estimates: &[StepEstimate],
    terms: &[Option<HessianDifference>],
    (repeats, mut held): (Vec<Vec<Repeat>>, Held),
    phase: PhaseId,
    has_control: bool,
    setup: &mut Setup<'_>,
) -> Result<(), SetupError> {
    let view = setup.world.phase(phase);
    let missing = |error: crate::world::MissingColumn| SetupError::internal(&error);
    let dimension = setup.world.dimension().count();
    let mut kernels = Vec::with_capacity(bodies.len());
    {
        let original = view.read::<ReferencePosition>().map_err(missing)?;
        let mut reference = view.write::<UpdatedReference>().map_err(missing)?;
        let mut support = view.write::<SupportRadius>().map_err(missing)?;
        reference.iter_mut().zip(original.iter()).for_each(|(now, start)| now.0 = start.0);
        let start = view.read::<ReferenceVolume>().map_err(missing)?;
        let mut volume = view.write::<UpdatedVolume>().map_err(missing)?;
        volume.iter_mut().zip(start.iter()).for_each(|(now, start)| now.0 = start.0);
        view.write::<UpdatedGradient>().map_err(missing)?.fill(UpdatedGradient(DMat3::IDENTITY));
        view.write::<UpdatedMetric>().map_err(missing)?.fill(UpdatedMetric(Sym3::IDENTITY));
        view.write::<DeformationGradient>().map_err(missing)?.fill(DeformationGradient(DMat3::IDENTITY));
        for (id, parameters) in bodies {
            let body = setup.world.body(*id);
            let radius = parameters.support * body.spacing;
            support[body.rows.clone()].fill(SupportRadius(radius));
            let Some(kernel) = Kernel::new(parameters.kernel, dimension) else {
                unreachable!("every kernel has a two- and a three-dimensional form");
            };
            kernels.push(BodyKernel { body: *id, kernel, support: Some(radius) });
        }
    }
    let carried = std::mem::take(&mut held.carried);
    let mut rows = UpdatedRows {
        bonds: Bonds { carried, ..Bonds::default() },
        held,
        ghosts: Ghosts::default(),
        repeats,
        origin: DVec3::ZERO,
        sites: Vec::new(),
        originals: Vec::new(),
        pair_sites: Vec::new(),
        gradient: Vec::new(),
        ellipsoids: Vec::new(),
        volume: Vec::new(),
        stresses: Vec::new(),
        control: Vec::new(),
        control_bonds: Bonds::default(),
        control_self_force: vec![DVec3::ZERO; view.len()],
        self_force: vec![DVec3::ZERO; view.len()],
        frames: Vec::with_capacity(bodies.len()),
        cracks: Cracks::default(),
        hessian: HessianRows::new(
            bodies.iter().zip(terms).map(|((id, _), term)| (setup.world.body(*id).rows.clone(), *term)),
        ),
        kernels,
        stable_step: Vec::with_capacity(bodies.len()),
        follows: Vec::with_capacity(bodies.len()),
        has_control,
        released_at_start: Vec::new(),
        search: NeighborSearch::default(),
    };
    rows.renew(setup.world, phase, estimates, &[]).map_err(|RenewError { body, error }| {
        let help = "use a larger `support`, or more particles across the body";
        SetupError::parameter(format!("bodies[{}].formulation", body.0), error.to_string(), help)
    })?;
    rows.warn_of_released_at_start(setup);
    setup.resources.insert_solid(phase, rows);
    Ok(())
}

/// Why the lists of a body cannot be made.
pub(super) struct RenewError {
    pub body: BodyId,
    pub error: BondError,
}

impl RenewError {
    /// The error of a step.
    pub fn in_step(self, world: &World) -> StepError {
        let Self { body, error } = self;
        let message = format!("the reference of body `{}` cannot be updated: {error}", world.body(body).name);
        StepError::System { system: "updated_lagrangian_gradient".to_owned(), message }
    }
}

impl UpdatedRows {
    /// Makes neighbours, weights, moments and ghosts of the reference that the columns hold, without `removed` rows.
    pub fn renew(
        &mut self,
        world: &World,
        phase: PhaseId,
        estimates: &[StepEstimate],
        removed: &[u32],
    ) -> Result<(), RenewError> {
        let view = world.phase(phase);
        let body = self.kernels[0].body;
        let internal = move |_| RenewError { body, error: BondError::NoStiffness { most: 0 } };
        let reference = view.read::<UpdatedReference>().map_err(internal)?;
        let volume = view.read::<UpdatedVolume>().map_err(internal)?;
        let support = view.read::<SupportRadius>().map_err(internal)?;
        let metric = view.read::<UpdatedMetric>().map_err(internal)?;
        let start = view.read::<ReferenceVolume>().map_err(internal)?;
        self.ellipsoids.clear();
        self.ellipsoids.extend(metric.iter().map(|metric| Ellipsoid::new(metric.0)));
        self.volume.clear();
        self.volume.extend(volume.iter().map(|volume| volume.0));
        removed.iter().for_each(|&row| self.volume[row as usize] = 0.0);
        let position: &[DVec3] = bytemuck::cast_slice(&reference);
        let support: &[f64] = bytemuck::cast_slice(&support);
        let bounds = |rows: Range<usize>| {
            let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            position[rows].iter().fold(start, |(low, high), &x| (low.min(x), high.max(x)))
        };
        let (low, high) = bounds(0..position.len());
        self.origin = 0.5 * (low + high);
        self.bonds = Bonds { carried: std::mem::take(&mut self.bonds.carried), ..Bonds::default() };
        self.ghosts = Ghosts::new(view.len());
        for (kernel, repeats) in self.kernels.iter().zip(&self.repeats) {
            let rows = world.body(kernel.body).rows.clone();
            let (low, high) = bounds(rows.clone());
            let radii = support[rows.clone()].iter().zip(&self.ellipsoids[rows.clone()]);
            let widest = radii.map(|(support, own)| support * own.longest).fold(0.0, f64::max);
            let (repeats, reach) = follow(repeats, low, high, widest);
            let ghost_rows = self.ghosts.add(rows.clone(), position, reach, &repeats);
            let ghosts = &self.ghosts;
            let volume = &self.volume[..];
            let body = BodyBonds {
                rows: rows.clone(),
                position,
                volume,
                support,
                ellipsoids: Some(Ellipsoids(&self.ellipsoids)),
                kernel: kernel.kernel,
                ghosts,
                ghost_rows,
                hidden: self.held.hidden_of(kernel.body),
            };
            let made = self.bonds.append(&body, &mut self.search);
            made.map_err(|error| RenewError { body: kernel.body, error })?;
        }
        self.release_lost();
        let start: &[f64] = bytemuck::cast_slice(&start);
        self.find_stable_steps(world, estimates, support, start);
        let all = view.len() + self.ghosts.len();
        self.sites.resize(all, Site::default());
        self.stresses.resize(all, CorrectedStress::default());
        self.pair_sites.resize(all, Site::default());
        self.hessian.resize(view.len(), self.ghosts.len());
        if self.has_control {
            self.originals.resize(all, Site::default());
            self.control.resize(all, CorrectedStress::default());
        }
        self.take_gradients(world, phase).map_err(internal)
    }

    /// Finds the stable step of each body in the reference, s, from support radii, m, and the volumes of the start, m3.
    fn find_stable_steps(
        &mut self,
        world: &World,
        estimates: &[StepEstimate],
        support: &[f64],
        start: &[f64],
    ) {
        self.stable_step.clear();
        for (kernel, estimate) in self.kernels.iter().zip(estimates) {
            let (rows, axes) = (world.body(kernel.body).rows.clone(), kernel.kernel.dimension());
            let seen = Ellipsoids(&self.ellipsoids);
            // What stabilizers store belongs to the present volume, the mass to that of the start.
            let grown = rows.clone().map(|row| self.volume[row] / start[row]).fold(1.0, f64::max);
            let (bond, hessian) = (grown * estimate.bond, grown * estimate.hessian);
            let estimate = &StepEstimate { bond, hessian, ..*estimate };
            self.stable_step.push(self.bonds.stable_step(rows, axes, estimate, support, Some(seen)));
        }
    }

    /// Takes the deformation gradients of the reference from their column.
    pub fn take_gradients(&mut self, world: &World, phase: PhaseId) -> Result<(), MissingColumn> {
        let view = world.phase(phase);
        self.gradient.clear();
        self.gradient.extend(view.read::<UpdatedGradient>()?.iter().map(|gradient| gradient.0));
        self.follows.clear();
        for BodyKernel { body, .. } in &self.kernels {
            let own = &self.gradient[world.body(*body).rows.clone()];
            self.follows.push(own.iter().any(|f_r| *f_r != DMat3::IDENTITY));
        }
        if self.has_control {
            let (original, support) = (view.read::<ReferencePosition>()?, view.read::<SupportRadius>()?);
            let damage = view.read::<Damage>().ok();
            let has_failed = |row: usize| damage.as_ref().is_some_and(|damage| damage[row].0 >= 1.0);
            let (original, support) = (bytemuck::cast_slice(&original), bytemuck::cast_slice(&support));
            self.weigh_control(world, original, support, has_failed);
        }
        Ok(())
    }

    /// Makes the bonds of the stabilizers: those of the reference with other weights, and moments of the original pair vectors.
    fn weigh_control(
        &mut self,
        world: &World,
        original: &[DVec3],
        support: &[f64],
        has_failed: impl Fn(usize) -> bool,
    ) {
        let Self { bonds, ghosts, gradient, kernels, control_bonds, volume, ellipsoids, .. } = self;
        let ellipsoids = Ellipsoids(ellipsoids);
        let mut weights = std::mem::take(&mut control_bonds.weights);
        weights.clear();
        for BodyKernel { body, kernel, .. } in kernels.iter() {
            let ratio = kernel.smoothing_length(1.0);
            for i in world.body(*body).rows.clone() {
                weights.extend(bonds.row(i).map(|(j, _)| {
                    let source = ghosts.source(j);
                    let signs = ghosts.mirror(j).unwrap_or(DVec3::ONE);
                    let x_ij = ghosts.pair(original, i, j);
                    let mean = 0.5 * (gradient[i] * x_ij + signs * (gradient[source] * (signs * x_ij)));
                    let h = 0.5 * (support[i] + support[source]) * ratio;
                    let distance = ellipsoids.distance(ghosts, i, j, mean);
                    (ellipsoids.density(ghosts, i, j) * kernel.pair_weight(distance, h)) as f32
                }));
            }
        }
        control_bonds.take_topology(bonds);
        control_bonds.weights = weights;
        let held: Vec<f64> =
            volume.iter().enumerate().map(|(row, v)| if has_failed(row) { 0.0 } else { *v }).collect();
        for BodyKernel { body, kernel, .. } in kernels.iter() {
            let rows = world.body(*body).rows.clone();
            control_bonds.correct(rows, kernel.dimension(), original, &held, ghosts);
        }
    }
}

/// The repeats of a body that has moved to these bounds, and how far from a side its ghosts have their sources: a body that fills a period goes along
/// with its motion, and its sides need not be flat any more.
fn follow(repeats: &[Repeat], low: DVec3, high: DVec3, support: f64) -> (Vec<Repeat>, f64) {
    let mut reach = support;
    let moved = repeats.iter().map(|repeat| match *repeat {
        Repeat::Period { axis, length, .. } => {
            reach = reach.max(support + high[axis] - low[axis] - length);
            Repeat::Period { axis, min: low[axis], length }
        }
        mirror @ Repeat::Mirror { .. } => mirror,
    });
    let moved = moved.collect();
    (moved, reach)
}
