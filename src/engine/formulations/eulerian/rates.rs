//! The velocity gradient at mid-step, and the update of the deformation gradient.
//!
//! With the Cayley map the change of F over its mean is dt L to rounding, which is what hypoelastic laws use,
//! and a rigid rotation stays one. Positions at the end of the step would give a rotating body a spurious
//! dilatation of omega^2 dt / 2.

use glam::{DMat3, DVec3};

use super::dilatation::{DilatationRate, gradient};
use super::gathered::{Arms, BATCH, FOURS, MomentSums, NeighborBatch, velocities, weighted};
use super::near::{MIN_SPREAD, NeighborRows};
use super::particle::EulerianParticle;
use super::rows::{EulerianRows, PointColumns};
use super::start;
use super::supports::{self, SupportMetric};
use super::within::Center;
use crate::formulations::bonded::SeenEllipsoid;
use crate::kernels::{Kernel, KernelProfile, KernelVisitor, ProfiledKernel, ScaledKernel};
use crate::linalg::Sym3;
use crate::parallel::{
    FourLanes, HotLoop, Lanes4, for_each_own_block, run_hot_on, share_rows, split_by_rows,
};
use crate::schedule::{Run, Step, StepError};
use crate::solids::fit;
use crate::world::{
    Damage, DeformationGradient, PhaseId, Position, ReferencePosition, ReferenceVolume, Removed, Velocity,
    World,
};

/// Label of the system that makes velocity and deformation gradients.
pub(super) const RATES: &str = "eulerian_rates";

/// The system.
pub(super) struct VelocityGradients {
    pub phase: PhaseId,
}

impl Run for VelocityGradients {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut packed = step.resources.solid_rows_mut::<EulerianRows>(self.phase);
        let view = step.world.phase(self.phase);
        let position = view.read_near::<Position>()?;
        let reference = view.read_near::<ReferencePosition>()?;
        let (place, start): (&[DVec3], &[DVec3]) =
            (bytemuck::cast_slice(&position), bytemuck::cast_slice(&reference));
        let mut deformation = view.write::<DeformationGradient>()?;
        if step.clock.step == 0 && step.clock.dt == 0.0 {
            let volume = view.read_near::<ReferenceVolume>()?;
            start::fit_gradients(&packed, start, place, bytemuck::cast_slice(&volume), &mut deformation);
        }
        if !packed.supports.is_loaded {
            packed.load_supports(&view.read_near::<SupportMetric>()?);
        }
        let velocity = view.read_near::<Velocity>()?;
        let motion: (&[DVec3], f64) = (bytemuck::cast_slice(&velocity), step.clock.dt);
        update_lists(&mut packed, place, start, motion, step.world)?;
        if step.clock.dt > 0.0 {
            let volume = view.read_near::<ReferenceVolume>()?;
            let columns = PointColumns {
                position: &position,
                velocity: &velocity,
                volume: &volume,
                deformation: &deformation,
            };
            let removed = view.read_near::<Removed>()?;
            let gone = (0..removed.len()).filter(|&row| removed[row] != Removed::NO);
            packed.pack(&columns, 0.5 * step.clock.dt, gone);
            packed.lists.leave_out_elsewhere(place, start, &deformation);
            let dilatation =
                if view.has::<DilatationRate>() { Some(view.read::<DilatationRate>()?) } else { None };
            let mut metric = view.write::<SupportMetric>()?;
            advance(&mut packed, (&mut deformation, &mut metric), dilatation.as_deref(), step.clock.dt);
            if packed.lists.bodies.iter().any(|body| body.is_stretched) {
                packed.load_supports(&metric);
            }
            if step.clock.step.is_multiple_of(supports::EVERY) {
                let damage = if view.has::<Damage>() { Some(view.read_near::<Damage>()?) } else { None };
                if packed.renew_supports(&mut metric, &deformation, damage.as_deref()) {
                    update_lists(&mut packed, place, start, motion, step.world)?;
                }
                supports::warn(&packed.lists.bodies, &deformation, damage.as_deref(), step);
            }
        }
        packed.lists.leave_out_elsewhere(place, start, &deformation);
        Ok(())
    }
}

/// Brings the lists up to date.
fn update_lists(
    packed: &mut EulerianRows,
    position: &[DVec3],
    reference: &[DVec3],
    motion: (&[DVec3], f64),
    world: &World,
) -> Result<(), StepError> {
    packed.update_lists(position, reference, motion).map_err(|(body, error)| {
        let message = format!("neighbours of body `{}` cannot be listed: {error}", world.body(body).name);
        StepError::System { system: RATES.to_owned(), message }
    })
}

/// Advances F and the supports of all bodies by a step of `dt`, s.
fn advance(
    packed: &mut EulerianRows,
    (deformation, metric): (&mut [DeformationGradient], &mut [SupportMetric]),
    dilatation: Option<&[DilatationRate]>,
    dt: f64,
) {
    let EulerianRows { lists, kernels, points, supports, near, plane, .. } = packed;
    for (body, of) in lists.bodies.iter().zip(kernels) {
        let rows = body.rows.clone();
        let own: &mut [DMat3] = bytemuck::cast_slice_mut(&mut deformation[rows.clone()]);
        let metric = &mut metric[rows.clone()];
        let near = near.of_rows(&lists.pairs, rows.clone());
        let advanced = AdvancedRows { deformation: &mut *own, metric: &mut *metric, near };
        for_each_own_block(advanced, &mut Vec::new(), &|first, block: AdvancedRows<'_>| {
            let first = rows.start + first;
            let (kernel, support, ellipsoids) = (of.kernel, body.support, supports.of(body));
            let (lists, points, plane) = (lists.pairs.indices(), &points[..], *plane);
            kernel.dispatch(Advance {
                kernel,
                support,
                lists,
                points,
                ellipsoids,
                first,
                plane,
                dilatation,
                dt,
                rows: block,
            });
        });
        share_rows(own);
        if body.is_stretched {
            share_rows(metric);
        }
    }
}

/// Packed rows that the pass writes, split by rows of one body.
struct AdvancedRows<'a> {
    deformation: &'a mut [DMat3],
    metric: &'a mut [SupportMetric],
    /// Scratch memory for the neighbours at mid-step.
    near: NeighborRows<'a>,
}

split_by_rows!(AdvancedRows { deformation, metric, near });

/// Advances F of a block.
struct Advance<'a> {
    kernel: Kernel,
    support: f64,
    /// Lists of all rows.
    lists: &'a [u32],
    points: &'a [EulerianParticle],
    /// Ellipsoids of all rows; empty where supports are spheres.
    ellipsoids: &'a [SeenEllipsoid],
    first: usize,
    plane: bool,
    /// Of all rows of the phase, if plugins change volumes.
    dilatation: Option<&'a [DilatationRate]>,
    dt: f64,
    rows: AdvancedRows<'a>,
}

impl KernelVisitor for Advance<'_> {
    type Output = ();

    fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) {
        let kernel = kernel.scaled(self.kernel.smoothing_length(self.support));
        run_hot_on(self.plane, AdvanceLoop { kernel, of: self });
    }
}

struct AdvanceLoop<'a, K: KernelProfile> {
    kernel: ScaledKernel<K>,
    of: Advance<'a>,
}

impl<K: KernelProfile> HotLoop for AdvanceLoop<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        if self.of.ellipsoids.is_empty() { self.over::<A, false>(a) } else { self.over::<A, true>(a) }
    }
}

impl<K: KernelProfile> AdvanceLoop<'_, K> {
    #[inline(always)]
    fn over<A: FourLanes, const STRETCHED: bool>(self, a: A) {
        let Self { kernel, of } = self;
        let Advance { support, lists, points, ellipsoids, first, dilatation, dt, rows, .. } = of;
        let AdvancedRows { deformation, metric, near: NeighborRows { offsets, neighbors, .. } } = rows;
        let begin = offsets[0];
        let mut batch = RateBatch::NONE;
        for (k, f) in deformation.iter_mut().enumerate() {
            let own = points[first + k];
            if own.place.0[3] <= 0.0 {
                continue;
            }
            let near = &mut neighbors[offsets[k] - begin..offsets[k + 1] - begin];
            let center = Center::<A, STRETCHED>::new(a, (first + k, own.place), support, ellipsoids);
            let count = center.find(a, &lists[offsets[k]..offsets[k + 1]], points, near);
            let [x, y, z, _] = own.velocity.0;
            batch.own = [Lanes4::splat(x), Lanes4::splat(y), Lanes4::splat(z)];
            let mut sums = GradientSums::ZERO;
            for near in near[..count].chunks(BATCH) {
                let fours = batch.gather(a, &center, near, points);
                batch.look_up::<K, STRETCHED>(&kernel, fours);
                sums.add(a, &mut batch, fours);
            }
            let Some(inverse) = sums.moment.sum(a, Lanes4::ZERO).0.inverse_above(MIN_SPREAD) else {
                continue;
            };
            let l = fit::<A, 3>(a, &sums.spread(a), &inverse);
            let mut rate = DMat3::from_cols(l[0].xyz(), l[1].xyz(), l[2].xyz());
            if let Some(dilatation) = dilatation {
                rate += gradient(dilatation[first + k].0, A::AXES == 2);
            }
            let half = rate * (0.5 * dt);
            if STRETCHED {
                metric[k].0 = turned(&metric[k].0, &cayley(&spin(&half)));
            }
            *f = cayley(&half) * *f;
        }
    }
}

/// The records of a batch of neighbours, four in a vector, and the pair weights.
struct RateBatch {
    arms: Arms,
    /// v_i in all lanes, m/s.
    own: [Lanes4; 3],
    /// v_ij, m/s.
    passing: [[Lanes4; 3]; FOURS],
    weights: [[f64; 4]; FOURS],
}

impl NeighborBatch for RateBatch {
    #[inline(always)]
    fn arms(&mut self) -> &mut Arms {
        &mut self.arms
    }

    #[inline(always)]
    fn put<A: FourLanes>(&mut self, a: A, n: usize, of: [&EulerianParticle; 4]) {
        let [x, y, z, _] = a.transpose(velocities(of));
        let z = if A::AXES == 3 { a.sub(z, self.own[2]) } else { Lanes4::ZERO };
        self.passing[n] = [a.sub(x, self.own[0]), a.sub(y, self.own[1]), z];
    }
}

impl RateBatch {
    const NONE: Self = Self {
        arms: Arms::NONE,
        own: [Lanes4::ZERO; 3],
        passing: [[Lanes4::ZERO; 3]; FOURS],
        weights: [[0.0; 4]; FOURS],
    };

    /// Evaluates the kernel. By number: a loop over contiguous rows is computed several at once.
    #[inline(always)]
    fn look_up<K: KernelProfile, const STRETCHED: bool>(&mut self, kernel: &ScaledKernel<K>, fours: usize) {
        let distances = self.arms.distances(fours);
        let weights = &mut self.weights.as_flattened_mut()[..distances.len()];
        for n in 0..distances.len() {
            weights[n] = kernel.pair_weight(distances[n]);
        }
        if STRETCHED {
            let density = self.arms.densities(weights.len());
            for n in 0..weights.len() {
                weights[n] *= density[n];
            }
        }
    }
}

/// Sums over the neighbours of a particle in lanes.
struct GradientSums {
    moment: MomentSums,
    /// `sum_j V_0,j w_ij v_ij (x) x_ij`, by columns.
    spread: [[Lanes4; 3]; 3],
}

impl GradientSums {
    const ZERO: Self = Self { moment: MomentSums::ZERO, spread: [[Lanes4::ZERO; 3]; 3] };

    /// Adds a batch, in two loops whose sums stay in registers.
    #[inline(always)]
    fn add<A: FourLanes>(&mut self, a: A, batch: &mut RateBatch, fours: usize) {
        for n in 0..fours {
            let arm = &mut batch.arms.arm[n];
            let weighted = weighted(a, a.mul(batch.arms.volume[n], Lanes4(batch.weights[n])), arm);
            self.moment.add(a, arm, &weighted);
            *arm = weighted;
        }
        for n in 0..fours {
            let (weighted, passing) = (&batch.arms.arm[n], &batch.passing[n]);
            for column in 0..A::AXES {
                for axis in 0..A::AXES {
                    self.spread[column][axis] =
                        a.mul_add(passing[axis], weighted[column], self.spread[column][axis]);
                }
            }
        }
    }

    /// The columns of the second sum.
    #[inline(always)]
    fn spread<A: FourLanes>(&self, a: A) -> [Lanes4; 3] {
        let mut columns = [Lanes4::ZERO; 3];
        for (column, [x, y, z]) in columns.iter_mut().zip(self.spread) {
            *column = a.sums([x, y, z, Lanes4::ZERO]);
        }
        columns
    }
}

/// (I - a)^-1 (I + a).
#[inline(always)]
fn cayley(a: &DMat3) -> DMat3 {
    (DMat3::IDENTITY - *a).inverse() * (DMat3::IDENTITY + *a)
}

/// Skew part of a tensor.
#[inline(always)]
fn spin(a: &DMat3) -> DMat3 {
    (*a - a.transpose()) * 0.5
}

/// A tensor after a turn.
#[inline(always)]
fn turned(g: &Sym3, turn: &DMat3) -> Sym3 {
    Sym3::symmetric_part(*turn * g.to_matrix() * turn.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::velocity_gradient_step;

    #[test]
    fn a_law_gets_the_velocity_gradient_back_from_the_change_of_f() {
        let l = DMat3::from_cols_array(&[0.1, -0.2, 0.05, 0.3, -0.15, 0.1, -0.04, 0.2, 0.12]);
        let f = DMat3::from_cols_array(&[1.2, 0.1, 0.0, -0.3, 0.9, 0.1, 0.2, 0.0, 1.1]);
        let step = velocity_gradient_step(&f, &(cayley(&(l * 0.5)) * f));
        assert!(step.abs_diff_eq(l, 1e-14), "{step}");
    }

    #[test]
    fn a_turn_stays_a_turn_however_far_it_goes() {
        let spin = DMat3::from_cols_array(&[0.0, 0.7, 0.0, -0.7, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let mut f = DMat3::IDENTITY;
        (0..1000).for_each(|_| f = cayley(&spin) * f);
        assert!((f.transpose() * f).abs_diff_eq(DMat3::IDENTITY, 1e-11));
    }
}
