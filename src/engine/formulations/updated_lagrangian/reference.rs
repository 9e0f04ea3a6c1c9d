//! The reference: neighbours, weights and moments at the positions of the last update.

use glam::DVec3;

use super::columns::{UpdatedGradient, UpdatedMetric, UpdatedReference, UpdatedVolume};
use super::control::ReferenceRows;
use super::lists::{ReferenceOfPhase, UpdatedBody};
use super::phase::UpdatedRows;
use crate::formulations::bonded::{BodyKernel, BondError, Ellipsoid, Ellipsoids, PackedParticle};
use crate::neighbors::{PointBounds, bounds};
use crate::parallel::for_each_block;
use crate::schedule::StepError;
use crate::solids::{CorrectedStress, StepEstimate};
use crate::symmetry::{Ghosts, Repeat};
use crate::world::{
    BodyId, MissingColumn, PhaseId, ReferencePosition, ReferenceVolume, SupportRadius, World,
};

/// Why the lists of a body cannot be built.
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
    /// Makes neighbours, weights, moments and ghosts of the reference that the columns hold, without
    /// `removed` rows.
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
        let reference = view.read_near::<UpdatedReference>().map_err(internal)?;
        let volume = view.read_near::<UpdatedVolume>().map_err(internal)?;
        let support = view.read_near::<SupportRadius>().map_err(internal)?;
        let metric = view.read::<UpdatedMetric>().map_err(internal)?;
        let start = view.read_near::<ReferenceVolume>().map_err(internal)?;
        let metric = &metric[..];
        self.ellipsoids.resize(metric.len(), Ellipsoid::SPHERE);
        for_each_block(&mut self.ellipsoids[..], &mut Vec::new(), &|first, own: &mut [Ellipsoid]| {
            own.iter_mut().zip(&metric[first..]).for_each(|(own, metric)| *own = Ellipsoid::new(metric.0));
        });
        self.volume.clear();
        self.volume.extend(volume.iter().map(|volume| volume.0));
        removed.iter().for_each(|&row| self.volume[row as usize] = 0.0);
        let support: &[f64] = bytemuck::cast_slice(&support);
        self.renew_bonds(world, bytemuck::cast_slice(&reference), support)?;
        self.release_lost();
        let start: &[f64] = bytemuck::cast_slice(&start);
        self.find_stable_steps(world, estimates, support, start);
        self.resize();
        Ok(())
    }

    /// Makes the bonds and ghosts of the reference at these positions, m, with these support radii, m.
    fn renew_bonds(&mut self, world: &World, position: &[DVec3], support: &[f64]) -> Result<(), RenewError> {
        self.origin = bounds(position).middle();
        self.ghosts = Ghosts::new(position.len());
        let mut bodies = Vec::with_capacity(self.kernels.len());
        for (k, (kernel, repeats)) in self.kernels.iter().zip(&self.repeats).enumerate() {
            let rows = world.body(kernel.body).rows.clone();
            let ghost_rows = if repeats.is_empty() {
                self.ghosts.add(rows.clone(), position, 0.0, &[])
            } else {
                let PointBounds { low, high } = bounds(&position[rows.clone()]);
                let radii = support[rows.clone()].iter().zip(&self.ellipsoids[rows.clone()]);
                let widest = radii.map(|(support, own)| support * own.longest).fold(0.0, f64::max);
                let (repeats, reach) = follow(repeats, low, high, widest);
                self.ghosts.add(rows.clone(), position, reach, &repeats)
            };
            let hidden = self.held.hidden_of(kernel.body);
            bodies.push(UpdatedBody { body: k, rows, ghost_rows, kernel: kernel.kernel, hidden });
        }
        let Self { lists, bonds, volume, ellipsoids, ghosts, kernels, control, .. } = self;
        control.bonds.leave_topology();
        let reference = ReferenceOfPhase { places: position, volumes: volume, support, ellipsoids, ghosts };
        lists.begin(&reference, bodies.iter().map(|body| body.rows.clone()));
        bonds.clear();
        for (own, BodyKernel { body, .. }) in bodies.iter().zip(kernels) {
            lists.append(&reference, own, bonds).map_err(|error| RenewError { body: *body, error })?;
        }
        Ok(())
    }

    /// Gives all rows and their ghosts a place.
    fn resize(&mut self) {
        let (real, all) = (self.volume.len(), self.volume.len() + self.ghosts.len());
        self.sites.resize(all, PackedParticle::default());
        self.stresses.resize(all, CorrectedStress::default());
        self.hessian.resize(real, self.ghosts.len());
    }

    /// Finds the stable step of each body in the reference, s, from support radii, m, and the volumes of the
    /// start, m3.
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

    /// Reads the deformation gradients of the reference from their column, and builds the bonds of the
    /// stabilizers without `failed` particles.
    pub fn take_gradients(
        &mut self,
        world: &World,
        phase: PhaseId,
        failed: &[u32],
    ) -> Result<(), MissingColumn> {
        let view = world.phase(phase);
        self.gradient.clear();
        self.gradient.extend(view.read_near::<UpdatedGradient>()?.iter().map(|gradient| gradient.0));
        let (reference, original) =
            (view.read_near::<UpdatedReference>()?, view.read_near::<ReferencePosition>()?);
        let start = view.read_near::<ReferenceVolume>()?;
        let original = bytemuck::cast_slice(&original);
        let present = ReferenceRows { places: bytemuck::cast_slice(&reference), volumes: &self.volume };
        let at_start = ReferenceRows { places: original, volumes: bytemuck::cast_slice(&start) };
        self.follows.clear();
        for BodyKernel { body, .. } in &self.kernels {
            let rows = world.body(*body).rows.clone();
            self.follows.push(!present.is_original(at_start, &self.gradient, rows));
        }
        self.weigh_control(world, original, bytemuck::cast_slice(&start), failed);
        if self.has_followed() && self.needs_pair_sites() {
            self.pair_sites.resize(self.sites.len(), PackedParticle::default());
        }
        Ok(())
    }
}

/// The repeats of a body that has moved to these bounds, and how far from a side its ghosts have their
/// sources: a body that fills a period moves along the axis, and its sides may deform.
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
