//! The loops over pairs that compute the rows of a block: distances, weights, moments. A lane is a neighbour.

use std::ops::Range;

use glam::DVec3;

use super::seen::{Columns, OwnParticle, SeenParticles};
use crate::correction::{MomentMatrix, add_moment};
use crate::formulations::bonded::FourSeen;
use crate::kernels::{KernelProfile, KernelVisitor, ProfiledKernel};
use crate::linalg::Sym3;
use crate::neighbors::NeighborList;
use crate::parallel::{FourLanes, HotLoop, Lanes4, Number, Vector, run_hot};

/// The rows of a block, built in parts, so that the distances of pairs stay in the first-level cache. Those
/// of pairs are longer than the used part.
#[derive(Default)]
pub(super) struct PairBlock {
    /// Where those of each row end.
    pub ends: Vec<usize>,
    pub neighbors: Vec<u32>,
    pub weights: Vec<f32>,
    pub corrections: Vec<Correction>,
    /// Number of bonds before those of the present part.
    begin: usize,
    /// Number of groups of four pairs that are measured in the part: those of a row begin with a group.
    groups: usize,
    /// Which pairs of each group are bonds.
    kept: Vec<u8>,
    /// Square of the distance as both ends measure it, m2.
    square: Vec<f64>,
    /// Factor of the kernel.
    density: Vec<f64>,
    /// Support radius, m.
    support: Vec<f64>,
    /// Weights of the pairs that are measured.
    measured: Vec<f32>,
    /// Particles within the largest radius of a particle.
    near: Vec<u32>,
}

/// Moments common to the bonds of a row.
#[derive(Clone, Copy)]
pub(super) struct Correction {
    /// Inverse moment matrix; zero where there is none.
    pub inverse: Sym3,
    /// `sum_j V_j w_ij x_ij`.
    pub first_moment: DVec3,
    /// `sum_j V_j w_ij`, 1/m2.
    pub weight_sum: f64,
}

/// Where pairs come from.
#[derive(Clone, Copy)]
pub(super) enum PairOrigin<'a> {
    /// Of those that may be neighbours, who is within the ellipsoids.
    Near {
        /// A row for every particle of the body.
        list: &'a NeighborList,
        /// First row of the body.
        first: usize,
        /// Square of the distance that no neighbour reaches, m2.
        square: f64,
    },
    /// Known pairs, whose vectors the deformation moves before they are measured.
    Known {
        /// Where the neighbours of each row start.
        offsets: &'a [u32],
        neighbors: &'a [u32],
        /// F_r of all rows.
        columns: &'a [Columns],
    },
}

/// Pairs of all rows.
#[derive(Clone, Copy)]
pub(super) struct RowPairs<'a> {
    pub seen: &'a SeenParticles,
    pub source: PairOrigin<'a>,
}

/// The lanes with one of that many neighbours.
const MASKS: [usize; 5] = [0, 1, 3, 7, 15];

impl PairBlock {
    /// Lets go of all rows; memory is kept.
    pub fn clear(&mut self) {
        self.ends.clear();
        self.corrections.clear();
    }

    /// Begins a part.
    #[inline(always)]
    fn begin_part(&mut self) {
        self.begin = self.len();
        self.groups = 0;
    }

    /// Allocates memory for a row of that many pairs behind the bonds that are used.
    #[inline(always)]
    fn reserve(&mut self, used: usize, count: usize) {
        let (len, groups) = (used + count + 4, self.groups + count / 4 + 1);
        if self.neighbors.len() < len {
            self.neighbors.resize(len * 3 / 2, 0);
            self.weights.resize(len * 3 / 2, 0.0);
        }
        if self.kept.len() < groups {
            let groups = groups * 3 / 2;
            self.kept.resize(groups, 0);
            self.square.resize(4 * groups, 0.0);
            self.density.resize(4 * groups, 0.0);
            self.support.resize(4 * groups, 0.0);
            self.measured.resize(4 * groups, 0.0);
        }
    }

    /// Puts a group of pairs behind the others, of which those whose bit is set are bonds.
    #[inline(always)]
    fn put<A: FourLanes>(&mut self, pairs: &FourSeen<A>, bits: usize) {
        let at = 4 * self.groups;
        put(&mut self.square, at, pairs.square.lanes());
        put(&mut self.density, at, pairs.density.lanes());
        put(&mut self.support, at, pairs.support.lanes());
        self.kept[self.groups] = bits as u8;
        self.groups += 1;
    }

    /// Number of bonds.
    pub fn len(&self) -> usize {
        self.ends.last().copied().unwrap_or(0)
    }
}

/// Four neighbours from the n-th on; where there are no more, the particle itself.
#[inline(always)]
fn four(row: &[u32], n: usize, own: usize) -> [usize; 4] {
    match row[n..].first_chunk::<4>() {
        Some(&[j, k, l, m]) => [j as usize, k as usize, l as usize, m as usize],
        None => {
            let mut rows = [own; 4];
            for k in 0..row.len() - n {
                rows[k] = row[n + k] as usize;
            }
            rows
        }
    }
}

/// The numbers of four rows, as lists hold them.
#[inline(always)]
fn numbers([j, k, l, m]: [usize; 4]) -> [u32; 4] {
    [j as u32, k as u32, l as u32, m as u32]
}

/// Finds the pairs of some rows and measures their distances.
pub(super) struct MeasurePairs<'a, 'b> {
    pub pairs: &'a RowPairs<'a>,
    pub rows: Range<usize>,
    pub block: &'b mut PairBlock,
}

impl HotLoop for MeasurePairs<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        if self.pairs.seen.has_ghosts() { self.run_with::<A, true>(a) } else { self.run_with::<A, false>(a) }
    }
}

impl MeasurePairs<'_, '_> {
    #[inline(always)]
    fn run_with<A: FourLanes, const GHOSTS: bool>(self, a: A) {
        let Self { pairs: RowPairs { seen, source, .. }, rows, block } = self;
        block.begin_part();
        let mut used = block.begin;
        for i in rows {
            match *source {
                PairOrigin::Near { list, first, square } => {
                    let near = NearSearch { seen, own: OwnParticle::new(a, seen, i), row: i };
                    let count = near.keep::<GHOSTS>(a, list.row(i - first), square, &mut block.near);
                    block.reserve(used, count);
                    used = near.measure::<GHOSTS>(a, count, used, block);
                }
                PairOrigin::Known { offsets, neighbors, columns } => {
                    let row = &neighbors[offsets[i] as usize..offsets[i + 1] as usize];
                    block.reserve(used, row.len());
                    let own = OwnParticle::moving(a, seen, i, &columns[i]);
                    for n in (0..row.len()).step_by(4) {
                        let rows = four(row, n, i);
                        let (arm, _) = own.arms::<GHOSTS>(a, seen, rows);
                        let moved = own.moved(a, arm, columns, rows);
                        block.put(&own.measure(a, moved, seen, rows), MASKS[(row.len() - n).min(4)]);
                    }
                    used += row.len();
                }
            }
            block.ends.push(used);
        }
    }
}

#[inline(always)]
fn put(values: &mut [f64], at: usize, four: Lanes4) {
    if let Some(to) = values[at..].first_chunk_mut::<4>() {
        *to = four.0;
    }
}

/// The search for what is near a particle.
struct NearSearch<'a, A: FourLanes> {
    seen: &'a SeenParticles,
    own: OwnParticle<A>,
    row: usize,
}

impl<A: FourLanes> NearSearch<'_, A> {
    /// Takes those candidates that are closer than the root of `square`; returns how many there are.
    #[inline(always)]
    fn keep<const GHOSTS: bool>(&self, a: A, candidates: &[u32], square: f64, near: &mut Vec<u32>) -> usize {
        if near.len() < candidates.len() + 4 {
            near.resize(candidates.len() + 4, 0);
        }
        let limit = Lanes4::splat(square);
        let mut used = 0;
        for n in (0..candidates.len()).step_by(4) {
            let rows = four(candidates, n, self.row);
            let (arm, _) = self.own.arms::<GHOSTS>(a, self.seen, rows);
            let mask = a.below(arm.length_squared().lanes(), limit) & MASKS[(candidates.len() - n).min(4)];
            if let Some(to) = near[used..].first_chunk_mut::<4>() {
                *to = a.pack(numbers(rows), mask);
            }
            used += mask.count_ones() as usize;
        }
        used
    }

    /// Puts those that are near and within the ellipsoids behind the bonds that are used; returns how many
    /// are used then.
    #[inline(always)]
    fn measure<const GHOSTS: bool>(
        &self,
        a: A,
        count: usize,
        mut used: usize,
        block: &mut PairBlock,
    ) -> usize {
        for n in (0..count).step_by(4) {
            let rows = four(&block.near[..count], n, self.row);
            let (arm, _) = self.own.arms::<GHOSTS>(a, self.seen, rows);
            let pairs = self.own.measure(a, arm, self.seen, rows);
            let limit = pairs.support.squared().lanes();
            let bits = a.below(pairs.square.lanes(), limit) & MASKS[(count - n).min(4)];
            block.put(&pairs, bits);
            if let Some(to) = block.neighbors[used..].first_chunk_mut::<4>() {
                *to = a.pack(numbers(rows), bits);
            }
            used += bits.count_ones() as usize;
        }
        used
    }
}

/// Makes the weights of distances.
pub(super) struct Weights<'a>(pub &'a mut PairBlock);

impl KernelVisitor for Weights<'_> {
    type Output = ();

    fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) {
        let PairBlock { begin, groups, kept, square, density, support, measured, weights, .. } = self.0;
        let count = 4 * *groups;
        let measured = &mut measured[..count];
        let (square, density, support) = (&square[..count], &density[..count], &support[..count]);
        run_hot(WeightLoop { kernel, square, density, support, weights: &mut *measured });
        run_hot(KeepWeights { kept, measured, weights: &mut weights[*begin..] });
    }
}

struct WeightLoop<'a, K: KernelProfile> {
    kernel: ProfiledKernel<K>,
    square: &'a [f64],
    density: &'a [f64],
    support: &'a [f64],
    weights: &'a mut [f32],
}

impl<K: KernelProfile> HotLoop for WeightLoop<'_, K> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let Self { kernel, square, density, support, weights } = self;
        let count = weights.len();
        let Some(&first) = support.first() else { return };
        let ratio = 1.0 / K::SUPPORT;
        let scaled = kernel.scaled(first * ratio);
        let mut is_uniform = true;
        for k in 0..count {
            is_uniform &= support[k] == first;
        }
        if is_uniform {
            for k in 0..count {
                weights[k] = (density[k] * scaled.pair_weight(square[k].sqrt())) as f32;
            }
        } else {
            for k in 0..count {
                let own = kernel.scaled(support[k] * ratio);
                weights[k] = (density[k] * own.pair_weight(square[k].sqrt())) as f32;
            }
        }
    }
}

/// Takes those weights whose bits are set.
struct KeepWeights<'a> {
    kept: &'a [u8],
    measured: &'a [f32],
    weights: &'a mut [f32],
}

impl HotLoop for KeepWeights<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Self { kept, measured, weights } = self;
        let (fours, _) = measured.as_chunks::<4>();
        let mut used = 0;
        for group in 0..fours.len() {
            let (four, bits) = (fours[group], kept[group] as usize);
            let bytes = [four[0].to_bits(), four[1].to_bits(), four[2].to_bits(), four[3].to_bits()];
            let [j, k, l, m] = a.pack(bytes, bits);
            if let Some(to) = weights[used..].first_chunk_mut::<4>() {
                *to = [f32::from_bits(j), f32::from_bits(k), f32::from_bits(l), f32::from_bits(m)];
            }
            used += bits.count_ones() as usize;
        }
    }
}

/// Makes the inverse moment matrices of some rows from the rounded weights; a neighbour without volume has no
/// part in them, and a row without volume has none.
pub(super) struct Corrections<'a, 'b> {
    pub pairs: &'a RowPairs<'a>,
    pub rows: Range<usize>,
    pub block: &'b mut PairBlock,
}

impl HotLoop for Corrections<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        if self.pairs.seen.has_ghosts() { self.run_with::<A, true>(a) } else { self.run_with::<A, false>(a) }
    }
}

impl Corrections<'_, '_> {
    #[inline(always)]
    fn run_with<A: FourLanes, const GHOSTS: bool>(self, a: A) {
        let Self { pairs: RowPairs { seen, source, .. }, rows, block } = self;
        let PairBlock { ends, neighbors, weights, corrections, begin, .. } = block;
        let (mut start, before) = (*begin, corrections.len());
        for (k, i) in rows.enumerate() {
            let end = ends[before + k];
            let row = match *source {
                PairOrigin::Near { .. } => &neighbors[start..end],
                PairOrigin::Known { offsets, neighbors, .. } => {
                    &neighbors[offsets[i] as usize..offsets[i + 1] as usize]
                }
            };
            corrections.push(correction::<A, GHOSTS>(a, seen, i, row, &weights[start..end]));
            start = end;
        }
    }
}

#[inline(always)]
fn correction<A: FourLanes, const GHOSTS: bool>(
    a: A,
    seen: &SeenParticles,
    i: usize,
    row: &[u32],
    weights: &[f32],
) -> Correction {
    let own = OwnParticle::new(a, seen, i);
    let (mut x, mut y, mut z) = (Vector::zero(a), Vector::zero(a), Vector::zero(a));
    let (mut first_moment, mut weight_sum) = (Vector::zero(a), Number::zero(a));
    for n in (0..row.len()).step_by(4) {
        let (arm, volume) = own.arms::<GHOSTS>(a, seen, four(row, n, i));
        let mut weight = Lanes4::ZERO;
        for lane in 0..(row.len() - n).min(4) {
            weight.0[lane] = f64::from(weights[n + lane]);
        }
        let volume_weight = volume * Number::new(a, weight);
        add_moment([&mut x, &mut y, &mut z], volume_weight, arm);
        first_moment = arm.mul_add(volume_weight, first_moment);
        weight_sum += volume_weight;
    }
    let [xx, xy, xz, yy] = a.sums([x.x.lanes(), x.y.lanes(), x.z.lanes(), y.y.lanes()]).0;
    let [yz, zz, first_x, first_y] =
        a.sums([y.z.lanes(), z.z.lanes(), first_moment.x.lanes(), first_moment.y.lanes()]).0;
    let [reach_z, weight_sum, _, _] =
        a.sums([first_moment.z.lanes(), weight_sum.lanes(), Lanes4::ZERO, Lanes4::ZERO]).0;
    let moment = MomentMatrix::of(Sym3 { xx, yy, zz, xy, xz, yz }, A::AXES);
    let inverse = if seen.places[i].0[3] > 0.0 { moment.inverse() } else { None };
    Correction {
        inverse: inverse.unwrap_or_default(),
        first_moment: DVec3::new(first_x, first_y, reach_z),
        weight_sum,
    }
}
