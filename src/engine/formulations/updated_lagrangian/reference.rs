//! The reference: neighbours, weights and moments at the positions of the last update.

use glam::{DMat3, DVec3};

use super::columns::{UpdatedGradient, UpdatedMetric, UpdatedReference, UpdatedVolume};
use super::phase::UpdatedRows;
use crate::formulations::total_lagrangian::{
    BodyBonds, BodyKernel, BondError, Bonds, Ellipsoid, Ellipsoids, Site,
};
use crate::schedule::StepError;
use crate::solids::{CorrectedStress, StepEstimate};
use crate::symmetry::{Ghosts, Repeat};
use crate::world::{
    BodyId, Damage, MissingColumn, PhaseId, ReferencePosition, ReferenceVolume, SupportRadius, World,
};

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
        let support: &[f64] = bytemuck::cast_slice(&support);
        self.renew_bonds(world, bytemuck::cast_slice(&reference), support)?;
        self.release_lost();
        let start: &[f64] = bytemuck::cast_slice(&start);
        self.find_stable_steps(world, estimates, support, start);
        self.resize();
        self.take_gradients(world, phase).map_err(internal)
    }

    /// Makes the bonds and ghosts of the reference at these positions, m, with these support radii, m.
    fn renew_bonds(&mut self, world: &World, position: &[DVec3], support: &[f64]) -> Result<(), RenewError> {
        let (low, high) = bounds(position);
        self.origin = 0.5 * (low + high);
        self.bonds = Bonds { carried: std::mem::take(&mut self.bonds.carried), ..Bonds::default() };
        self.ghosts = Ghosts::new(position.len());
        for (kernel, repeats) in self.kernels.iter().zip(&self.repeats) {
            let rows = world.body(kernel.body).rows.clone();
            let (low, high) = bounds(&position[rows.clone()]);
            let radii = support[rows.clone()].iter().zip(&self.ellipsoids[rows.clone()]);
            let widest = radii.map(|(support, own)| support * own.longest).fold(0.0, f64::max);
            let (repeats, reach) = follow(repeats, low, high, widest);
            let ghost_rows = self.ghosts.add(rows.clone(), position, reach, &repeats);
            let body = BodyBonds {
                rows,
                position,
                volume: &self.volume,
                support,
                ellipsoids: Some(Ellipsoids(&self.ellipsoids)),
                kernel: kernel.kernel,
                ghosts: &self.ghosts,
                ghost_rows,
                hidden: self.held.hidden_of(kernel.body),
            };
            let made = self.bonds.append(&body, &mut self.search);
            made.map_err(|error| RenewError { body: kernel.body, error })?;
        }
        Ok(())
    }

    /// Gives all rows and their ghosts a place.
    fn resize(&mut self) {
        let (real, all) = (self.volume.len(), self.volume.len() + self.ghosts.len());
        self.sites.resize(all, Site::default());
        self.stresses.resize(all, CorrectedStress::default());
        self.pair_sites.resize(all, Site::default());
        self.hessian.resize(real, self.ghosts.len());
        if self.has_control {
            self.originals.resize(all, Site::default());
            self.control.resize(all, CorrectedStress::default());
        }
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
        control_bonds.take_topology(bonds);
        for BodyKernel { body, kernel, .. } in kernels.iter() {
            let ratio = kernel.smoothing_length(1.0);
            control_bonds.set_weights(world.body(*body).rows.clone(), |i, j| {
                let source = ghosts.source(j);
                let signs = ghosts.mirror(j).unwrap_or(DVec3::ONE);
                let x_ij = ghosts.pair(original, i, j);
                let mean = 0.5 * (gradient[i] * x_ij + signs * (gradient[source] * (signs * x_ij)));
                let h = 0.5 * (support[i] + support[source]) * ratio;
                let distance = ellipsoids.distance(ghosts, i, j, mean);
                (ellipsoids.density(ghosts, i, j) * kernel.pair_weight(distance, h)) as f32
            });
        }
        let held: Vec<f64> =
            volume.iter().enumerate().map(|(row, v)| if has_failed(row) { 0.0 } else { *v }).collect();
        for BodyKernel { body, kernel, .. } in kernels.iter() {
            let rows = world.body(*body).rows.clone();
            control_bonds.correct(rows, kernel.dimension(), original, &held, ghosts);
        }
    }
}

/// The corners of the box around some points.
fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    points.iter().fold(start, |(low, high), &x| (low.min(x), high.max(x)))
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
