//! The neighbours within the support at the end of a step, with their weights, and the sums that correct the
//! gradient.

use super::particle::EulerianParticle;
use super::within::{CHUNK, Within};
use crate::correction::MomentMatrix;
use crate::kernels::{Kernel, KernelProfile, KernelVisitor, ProfiledKernel, ScaledKernel};
use crate::linalg::Sym3;
use crate::parallel::{FourLanes, Lanes4, PlaneOrSpace, Split, run_hot_in};

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
    pub first: usize,
    pub plane: bool,
    pub rows: &'r mut NeighborRows<'a>,
}

impl KernelVisitor for ComputePairs<'_, '_> {
    type Output = ();

    fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) {
        let kernel = kernel.scaled(self.kernel.smoothing_length(self.support));
        run_hot_in(self.plane, PairLoop { kernel, look: self });
    }
}

struct PairLoop<'a, 'r, K: KernelProfile> {
    kernel: ScaledKernel<K>,
    look: ComputePairs<'a, 'r>,
}

impl<K: KernelProfile> PlaneOrSpace for PairLoop<'_, '_, K> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Self { kernel, look: ComputePairs { support, lists, points, first, rows, .. } } = self;
        let limit = support * support;
        let itself = kernel.w(0.0);
        let begin = rows.offsets[0];
        let mut values = [0.0; CHUNK];
        for k in 0..rows.around.len() {
            let own = points[first + k].place;
            let start = rows.offsets[k] - begin;
            let list = if own.0[3] > 0.0 { rows.offsets[k]..rows.offsets[k + 1] } else { 0..0 };
            let (mut moment, mut first_moment) = ([Lanes4::ZERO; D], Lanes4::ZERO);
            let (mut weight_sum, mut filled) = (0.0, itself * points[first + k].velocity.0[3]);
            let mut count = 0;
            for list in lists[list].chunks(CHUNK) {
                let from = start + count;
                let slots = from..from + list.len();
                let (neighbors, squares) = (&mut rows.neighbors[slots.clone()], &mut rows.weights[slots]);
                let found = Within { neighbors, squares }.find(a, list, (own, limit), points);
                let part = from..from + found;
                let neighbors = &rows.neighbors[part.clone()];
                let (weights, curvatures) = (&mut rows.weights[part.clone()], &mut rows.curvatures[part]);
                // By number: a loop over contiguous rows is computed several at once.
                for n in 0..found {
                    let distance = weights[n].sqrt();
                    weights[n] = kernel.pair_weight(distance);
                    values[n] = kernel.w(distance);
                    curvatures[n] = kernel.d2w_dr2(distance) as f32;
                }
                for n in 0..found {
                    let EulerianParticle { place: other, velocity } = points[neighbors[n] as usize];
                    let (arm, weight) = (a.sub(other, own), other.0[3] * weights[n]);
                    let weighted = a.scale(weight, arm);
                    for axis in 0..D {
                        moment[axis] = a.scale_add(arm.0[axis], weighted, moment[axis]);
                    }
                    first_moment = a.add(first_moment, weighted);
                    weight_sum += weight;
                    filled += velocity.0[3] * values[n];
                }
                count += found;
            }
            let inverse_moment =
                MomentMatrix::of_columns(&moment).inverse_above(MIN_SPREAD).unwrap_or_default();
            let count = count as u32;
            rows.around[k] =
                NearbyMotion { count, inverse_moment, first_moment: first_moment.xyz(), weight_sum, filled };
        }
    }
}
