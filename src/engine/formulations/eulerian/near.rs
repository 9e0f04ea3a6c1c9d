//! The neighbours within the support at the end of a step, with their weights, and the sums that correct the
//! gradient.

use std::ops::Range;

use super::gathered::{Arms, BATCH, FOURS, MomentSums, NeighborBatch, velocities, weighted};
use super::particle::EulerianParticle;
use super::within::Center;
use crate::formulations::bonded::SeenEllipsoid;
use crate::kernels::{Kernel, KernelProfile, KernelVisitor, ProfiledKernel, ScaledKernel};
use crate::linalg::Sym3;
use crate::neighbors::NeighborList;
use crate::parallel::{FourLanes, HotLoop, Lanes4, Split, run_hot_on};

/// Minimum determinant of M_i in units of `(tr M_i / d)^d`. Below it the neighbours are so nearly on a line,
/// or in space in a plane, that a gradient across it is noise: what is left of a body that has separated
/// fully. Spacings along two axes may differ by more than two, corners of bodies have above 0.8.
pub(super) const MIN_SPREAD: f64 = 0.02;

/// Results of the pass for every row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NearbyMotion {
    /// Number of neighbours within the support.
    pub count: u32,
    /// Inverse of M_i; zero for a particle with too few neighbours.
    pub inverse_moment: Sym3,
    /// `sum_j V_0,j w_ij x_ij`, 1/m.
    pub first_moment: glam::DVec3,
    /// `sum_j V_0,j w_ij`, 1/m2.
    pub weight_sum: f64,
    /// `sum_j V_j W_ij` with the particle itself: 1 inside of a body.
    pub filled: f64,
}

/// The neighbours within the support: those of row i begin where its list does.
#[derive(Default)]
pub(super) struct EulerianNeighbors {
    pub neighbors: Vec<u32>,
    pub weights: Vec<f64>,
    /// Second derivatives W''_ij, for hourglass control.
    pub curvatures: Vec<f32>,
    pub around: Vec<NearbyMotion>,
}

impl EulerianNeighbors {
    /// Neighbours and weights of a row.
    #[inline(always)]
    pub fn row(&self, start: usize, i: usize) -> (&[u32], &[f64]) {
        let part = start..start + self.around[i].count as usize;
        (&self.neighbors[part.clone()], &self.weights[part])
    }

    /// What a pass over some rows writes.
    pub fn of_rows<'a>(&'a mut self, lists: &'a NeighborList, rows: Range<usize>) -> NeighborRows<'a> {
        let offsets = &lists.offsets()[rows.start..=rows.end];
        let slots = offsets[0]..offsets[rows.len()];
        NeighborRows {
            offsets,
            neighbors: &mut self.neighbors[slots.clone()],
            weights: &mut self.weights[slots.clone()],
            curvatures: &mut self.curvatures[slots],
            around: &mut self.around[rows],
        }
    }
}

/// The rows of [`EulerianNeighbors`] that a block writes.
pub(super) struct NeighborRows<'a> {
    /// Where the lists of these rows start, and where the last one ends.
    pub offsets: &'a [usize],
    pub neighbors: &'a mut [u32],
    pub weights: &'a mut [f64],
    pub curvatures: &'a mut [f32],
    pub around: &'a mut [NearbyMotion],
}

impl Split for NeighborRows<'_> {
    fn rows(&self) -> usize {
        self.around.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let Self { offsets, neighbors, weights, curvatures, around } = self;
        let cut = offsets[at] - offsets[0];
        let (neighbors, neighbors_rest) = neighbors.split_at_mut(cut);
        let (weights, weights_rest) = weights.split_at_mut(cut);
        let (curvatures, curvatures_rest) = curvatures.split_at_mut(cut);
        let (around, around_rest) = around.split_at_mut(at);
        (
            Self { offsets: &offsets[..=at], neighbors, weights, curvatures, around },
            Self {
                offsets: &offsets[at..],
                neighbors: neighbors_rest,
                weights: weights_rest,
                curvatures: curvatures_rest,
                around: around_rest,
            },
        )
    }
}

/// Computes the pairs of the lists of a block.
pub(super) struct ComputePairs<'a, 'r> {
    pub kernel: Kernel,
    /// Support radius, m.
    pub support: f64,
    /// Lists of all rows.
    pub lists: &'a [u32],
    pub points: &'a [EulerianParticle],
    /// Ellipsoids of all rows; empty where supports are spheres.
    pub ellipsoids: &'a [SeenEllipsoid],
    pub first: usize,
    pub plane: bool,
    pub rows: &'r mut NeighborRows<'a>,
}

impl KernelVisitor for ComputePairs<'_, '_> {
    type Output = ();

    fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) {
        let kernel = kernel.scaled(self.kernel.smoothing_length(self.support));
        run_hot_on(self.plane, PairLoop { kernel, look: self });
    }
}

struct PairLoop<'a, 'r, K: KernelProfile> {
    kernel: ScaledKernel<K>,
    look: ComputePairs<'a, 'r>,
}

impl<K: KernelProfile> HotLoop for PairLoop<'_, '_, K> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        if self.look.ellipsoids.is_empty() { self.over::<A, false>(a) } else { self.over::<A, true>(a) }
    }
}

impl<K: KernelProfile> PairLoop<'_, '_, K> {
    #[inline(always)]
    fn over<A: FourLanes, const STRETCHED: bool>(self, a: A) {
        let Self { kernel, look: ComputePairs { support, lists, points, ellipsoids, first, rows, .. } } =
            self;
        let itself = kernel.w(0.0);
        let begin = rows.offsets[0];
        let mut batch = NearBatch::NONE;
        for k in 0..rows.around.len() {
            let own = points[first + k];
            let list = if own.place.0[3] > 0.0 { rows.offsets[k]..rows.offsets[k + 1] } else { 0..0 };
            let slots = rows.offsets[k] - begin..rows.offsets[k] - begin + list.len();
            let center = Center::<A, STRETCHED>::new(a, (first + k, own.place), support, ellipsoids);
            let count = center.find(a, &lists[list], points, &mut rows.neighbors[slots.clone()]);
            let mut sums = NearbySums::ZERO;
            let mut from = slots.start;
            for near in rows.neighbors[slots][..count].chunks(BATCH) {
                let fours = batch.gather(a, &center, near, points);
                batch.look_up::<K, STRETCHED>(&kernel, fours);
                sums.add(a, &batch, fours);
                let part = from..from + near.len();
                rows.weights[part.clone()].copy_from_slice(&batch.weights.as_flattened()[..near.len()]);
                rows.curvatures[part].copy_from_slice(&batch.curvatures[..near.len()]);
                from += near.len();
            }
            rows.around[k] = sums.of(a, count, itself * own.velocity.0[3]);
        }
    }
}

/// The records of a batch of neighbours, four in a vector, and the kernel at them.
struct NearBatch {
    arms: Arms,
    /// V_j, m3.
    present: [Lanes4; FOURS],
    weights: [[f64; 4]; FOURS],
    values: [[f64; 4]; FOURS],
    curvatures: [f32; BATCH],
}

impl NeighborBatch for NearBatch {
    #[inline(always)]
    fn arms(&mut self) -> &mut Arms {
        &mut self.arms
    }

    #[inline(always)]
    fn put<A: FourLanes>(&mut self, a: A, n: usize, of: [&EulerianParticle; 4]) {
        let [_, _, _, present] = a.transpose(velocities(of));
        self.present[n] = present;
    }
}

impl NearBatch {
    const NONE: Self = Self {
        arms: Arms::NONE,
        present: [Lanes4::ZERO; FOURS],
        weights: [[0.0; 4]; FOURS],
        values: [[0.0; 4]; FOURS],
        curvatures: [0.0; BATCH],
    };

    /// Evaluates the kernel. By number: a loop over contiguous rows is computed several at once.
    #[inline(always)]
    fn look_up<K: KernelProfile, const STRETCHED: bool>(&mut self, kernel: &ScaledKernel<K>, fours: usize) {
        let distances = self.arms.distances(fours);
        let number = distances.len();
        let weights = &mut self.weights.as_flattened_mut()[..number];
        let values = &mut self.values.as_flattened_mut()[..number];
        let curvatures = &mut self.curvatures[..number];
        for n in 0..number {
            weights[n] = kernel.pair_weight(distances[n]);
            values[n] = kernel.w(distances[n]);
            curvatures[n] = kernel.d2w_dr2(distances[n]) as f32;
        }
        if STRETCHED {
            let density = self.arms.densities(number);
            for n in 0..number {
                weights[n] *= density[n];
                values[n] *= density[n];
                curvatures[n] *= density[n] as f32;
            }
        }
    }
}

/// The sums of [`NearbyMotion`] in lanes.
struct NearbySums {
    moment: MomentSums,
    first_moment: [Lanes4; 3],
    weight: Lanes4,
    filled: Lanes4,
}

impl NearbySums {
    const ZERO: Self = Self {
        moment: MomentSums::ZERO,
        first_moment: [Lanes4::ZERO; 3],
        weight: Lanes4::ZERO,
        filled: Lanes4::ZERO,
    };

    #[inline(always)]
    fn add<A: FourLanes>(&mut self, a: A, batch: &NearBatch, fours: usize) {
        for n in 0..fours {
            let weight = a.mul(batch.arms.volume[n], Lanes4(batch.weights[n]));
            let arm = &batch.arms.arm[n];
            let weighted = weighted(a, weight, arm);
            self.moment.add(a, arm, &weighted);
            for axis in 0..A::AXES {
                self.first_moment[axis] = a.add(self.first_moment[axis], weighted[axis]);
            }
            self.weight = a.add(self.weight, weight);
            self.filled = a.mul_add(batch.present[n], Lanes4(batch.values[n]), self.filled);
        }
    }

    /// The results for a particle with `count` neighbours that fills `itself` alone.
    #[inline(always)]
    fn of<A: FourLanes>(&self, a: A, count: usize, itself: f64) -> NearbyMotion {
        let (moment, filled) = self.moment.sum(a, self.filled);
        let [x, y, z] = self.first_moment;
        let first = a.sums([x, y, z, self.weight]);
        NearbyMotion {
            count: count as u32,
            inverse_moment: moment.inverse_above(MIN_SPREAD).unwrap_or_default(),
            first_moment: first.xyz(),
            weight_sum: first.0[3],
            filled: itself + filled,
        }
    }
}
