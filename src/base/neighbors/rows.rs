//! Rows of a neighbour list from a grid, in parallel.
//!
//! Rows are found block by block and copied into the list. Blocks are processed in waves, which bound the
//! memory needed beside the list. Particles with consecutive rows share candidates in the cache: set-up and
//! sorting place most of them near each other.

use super::grid::{Grid, Ranges};
use super::periodic::SHIFT;
use super::{Cloud, NeighborList, Periodic, SupportRadii};
use crate::parallel::{FourLanes, HotLoop, Lanes4, run_hot};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// Rows per block, found in sequence by one thread.
const BLOCK: usize = 128;
/// Blocks per wave, for each thread and at most: the rows of a wave are in memory twice.
const WAVE_OF_THREAD: usize = 16;
const WAVE: usize = 1024;

/// Buffers of one wave, reused from one build to the next.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    blocks: Vec<RowBlock>,
}

/// The concatenated rows of one block.
#[derive(Debug, Default)]
struct RowBlock {
    ends: Vec<usize>,
    /// Longer than its used part: four candidates are written at once, and only those within the radius are
    /// kept.
    found: Vec<u32>,
    /// Candidates of a row.
    ranges: Ranges,
}

/// Task of a neighbour search.
pub(super) struct Query<'a> {
    pub grid: &'a Grid,
    pub targets: Cloud<'a>,
    pub same_set: bool,
    /// Maximum pair radius (m), skin included.
    pub radius: f64,
    pub skin: f64,
    pub periodic: &'a Periodic,
    /// Whether the z coordinates of particles differ.
    pub solid: bool,
    pub order: Order<'a>,
    /// Half the edge lengths of the targets, m, where targets are boxes: a source within the radius of the
    /// box is a neighbour.
    pub halves: Option<&'a [DVec3]>,
    /// The targets whose rows are built, ascending; `None` for all.
    pub only: Option<&'a [Range<usize>]>,
    /// Takes more out of the rows.
    pub sift: Option<Sift<'a>>,
}

/// Takes neighbours out of consecutive rows: called with the number of the first, the ends of all, and the
/// concatenated rows, to be written in place.
pub type Sift<'a> = &'a (dyn Fn(usize, &mut [usize], &mut [u32]) + Sync);

/// Order of a row.
#[derive(Clone, Copy)]
pub(super) enum Order<'a> {
    /// Ascending.
    Rows,
    /// By groups of sources, which end at these indices, and within a group by cells.
    Groups(&'a [u32]),
    /// By cells, in one group.
    Cells,
}

impl Query<'_> {
    #[inline(always)]
    fn is_wanted(&self, i: usize) -> bool {
        self.only.is_none_or(|only| only.iter().any(|rows| rows.contains(&i)))
    }

    /// Adds the rows behind those of the list, over what its indices hold beyond them.
    pub fn fill(&self, buffers: &mut Buffers, list: &mut NeighborList) {
        let uniform =
            matches!(self.targets.support, SupportRadii::Uniform(_)) && self.grid.supports.is_empty();
        match (self.periodic.any(), uniform) {
            (false, true) if self.halves.is_some() => self.fill_as::<3, false, true, true>(buffers, list),
            (true, true) if self.halves.is_some() => self.fill_as::<3, true, true, true>(buffers, list),
            (false, true) if self.solid => self.fill_as::<3, false, true, false>(buffers, list),
            (false, true) => self.fill_as::<2, false, true, false>(buffers, list),
            (false, false) => self.fill_as::<3, false, false, false>(buffers, list),
            (true, true) => self.fill_as::<3, true, true, false>(buffers, list),
            (true, false) => self.fill_as::<3, true, false, false>(buffers, list),
        }
    }

    fn fill_as<const D: usize, const PERIODIC: bool, const UNIFORM: bool, const BOXES: bool>(
        &self,
        buffers: &mut Buffers,
        list: &mut NeighborList,
    ) {
        let rows = self.targets.positions.len();
        let blocks = &mut buffers.blocks;
        let of_wave = (WAVE_OF_THREAD * rayon::current_num_threads()).min(WAVE);
        blocks.resize_with(blocks.len().max(rows.div_ceil(BLOCK).min(of_wave)), RowBlock::default);
        let (rows_before, pairs_before) = (list.rows(), list.offsets[list.rows()]);
        list.offsets.reserve(rows);
        for first in (0..rows).step_by(BLOCK * of_wave) {
            let last = (first + BLOCK * of_wave).min(rows);
            let wave = &mut blocks[..(last - first).div_ceil(BLOCK)];
            wave.par_iter_mut().enumerate().for_each(|(b, block)| {
                let start = first + b * BLOCK;
                let rows = start..(start + BLOCK).min(last);
                run_hot(BlockRows::<D, PERIODIC, UNIFORM, BOXES> { query: self, rows, block: &mut *block });
                if let Some(sift) = self.sift {
                    sift(start, &mut block.ends, &mut block.found);
                }
            });

            let before = list.offsets[rows_before + first];
            let mut total = before;
            for block in &*wave {
                list.offsets.extend(block.ends.iter().map(|end| total + end));
                total = list.offsets[list.offsets.len() - 1];
            }
            if list.indices.len() < total {
                if list.indices.capacity() < total {
                    // A list that has outgrown its capacity gets a reserve, so that further growth seldom
                    // allocates.
                    let spare = if list.indices.capacity() == 0 { 1.02 } else { 1.25 };
                    let found = (total - pairs_before) as f64 / last as f64;
                    let expected = pairs_before + (found * rows as f64 * spare) as usize;
                    list.indices.reserve_exact(expected.max(total) - list.indices.len());
                }
                list.indices.resize(total, 0);
            }
            let mut free = &mut list.indices[before..total];
            let mut parts: [&mut [u32]; WAVE] = std::array::from_fn(|_| &mut [][..]);
            for (part, block) in parts.iter_mut().zip(&*wave) {
                (*part, free) = free.split_at_mut(block.ends.last().copied().unwrap_or(0));
            }
            parts[..wave.len()].par_iter_mut().zip(&*wave).for_each(|(part, block)| {
                part.copy_from_slice(&block.found[..part.len()]);
            });
        }
        list.indices.truncate(list.offsets[rows_before + rows]);
    }
}

/// The rows of a block in D dimensions.
struct BlockRows<'a, const D: usize, const PERIODIC: bool, const UNIFORM: bool, const BOXES: bool> {
    query: &'a Query<'a>,
    rows: Range<usize>,
    block: &'a mut RowBlock,
}

impl<const D: usize, const PERIODIC: bool, const UNIFORM: bool, const BOXES: bool> HotLoop
    for BlockRows<'_, D, PERIODIC, UNIFORM, BOXES>
{
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Query { grid, targets, same_set, radius, order, .. } = *self.query;
        let test = Test::<D, PERIODIC, UNIFORM, BOXES>::new(self.query);
        let halves = self.query.halves.unwrap_or_default();
        let sorted = grid.rows();
        let RowBlock { ends, found, ranges } = self.block;
        ends.clear();
        let mut used = 0;
        for i in self.rows {
            if !self.query.is_wanted(i) {
                ends.push(used);
                continue;
            }
            let start = used;
            let x_i = targets.positions[i];
            let support_i = if UNIFORM { 0.0 } else { targets.support_of(i) };
            let half = if BOXES { halves[i] } else { DVec3::ZERO };
            let place = SearchBox { center: x_i, half, support: support_i };
            grid.around(x_i, if BOXES { radius + half.length() } else { radius }, ranges);
            if found.len() < used + ranges.padded_len {
                found.resize((used + ranges.padded_len) * 3 / 2, 0);
            }
            let found = found.as_mut_slice();
            for range in &ranges.found {
                let before = used;
                let count = (range.end - range.first) as usize;
                let fours = count.div_ceil(4);
                let last = MASKS[(count + 4 - 4 * fours).min(4)];
                let (candidates, four_rows) = test.candidates(sorted, range.first as usize, fours);
                for (k, four_rows) in four_rows.iter().enumerate() {
                    let mask = if k + 1 < fours { MASKS[4] } else { last };
                    let near = test.near(a, &candidates, k, &place) & mask;
                    if let Some(out) = found[used..].first_chunk_mut() {
                        *out = a.pack(*four_rows, near);
                    }
                    used += near.count_ones() as usize;
                }
                if same_set && range.holds_own {
                    used = without(&mut found[..used], before, i as u32);
                }
            }
            let row = &mut found[start..used];
            match order {
                Order::Cells => grid.order(row),
                Order::Groups(ends) if !is_mixed(row, ends) => grid.order(row),
                Order::Groups(_) | Order::Rows => row.sort_unstable(),
            }
            ends.push(used);
        }
    }
}

/// Mask of the lanes in use, by the number of candidates.
const MASKS: [usize; 5] = [0, 1, 3, 7, 15];

/// Removes one value from those from `first` on and returns their new end.
#[inline(always)]
fn without(values: &mut [u32], first: usize, value: u32) -> usize {
    let mut kept = first;
    for k in first..values.len() {
        values[kept] = values[k];
        kept += usize::from(values[k] != value);
    }
    kept
}

/// The distance test in D dimensions.
struct Test<'a, const D: usize, const PERIODIC: bool, const UNIFORM: bool, const BOXES: bool> {
    coordinates: [&'a [f64]; 3],
    supports: &'a [f64],
    length: DVec3,
    inverse: DVec3,
    skin: f64,
    /// Square of the maximum pair radius.
    square: f64,
}

impl<'a, const D: usize, const PERIODIC: bool, const UNIFORM: bool, const BOXES: bool>
    Test<'a, D, PERIODIC, UNIFORM, BOXES>
{
    #[inline(always)]
    fn new(query: &Query<'a>) -> Self {
        let Query { grid, periodic, skin, radius, .. } = *query;
        let (length, inverse) = (periodic.lengths(), periodic.inverse_lengths());
        Self {
            coordinates: grid.coordinates(),
            supports: &grid.supports,
            length,
            inverse,
            skin,
            square: radius * radius,
        }
    }

    /// Coordinates, support radii and rows of sorted particles from `first` on, in `fours` groups of four.
    #[inline(always)]
    fn candidates(
        &self,
        sorted: &'a [u32],
        first: usize,
        fours: usize,
    ) -> (CandidateFours<'a, D>, &'a [[u32; 4]]) {
        let mut coordinates: [&[[f64; 4]]; D] = [&[]; D];
        for axis in 0..D {
            coordinates[axis] = fours_of(self.coordinates[axis], first, fours);
        }
        let supports = if UNIFORM { &[] } else { fours_of(self.supports, first, fours) };
        (CandidateFours { coordinates, supports }, fours_of(sorted, first, fours))
    }

    /// Bit mask of those of the k-th four candidates that are neighbours of a target.
    #[inline(always)]
    fn near<A: FourLanes>(
        &self,
        a: A,
        candidates: &CandidateFours<'_, D>,
        k: usize,
        place: &SearchBox,
    ) -> usize {
        let (x_i, half) = (place.center.to_array(), place.half.to_array());
        let mut square = Lanes4::ZERO;
        for axis in 0..D {
            let mut x = a.sub(Lanes4(candidates.coordinates[axis][k]), Lanes4::splat(x_i[axis]));
            if PERIODIC {
                let shift = Lanes4::splat(SHIFT);
                let turns = a.sub(a.scale_add(self.inverse[axis], x, shift), shift);
                x = a.scale_add(-self.length[axis], turns, x);
            }
            if BOXES {
                let distance = a.max(x, a.scale(-1.0, x));
                x = a.max_zero(a.sub(distance, Lanes4::splat(half[axis])));
            }
            square = a.mul_add(x, x, square);
        }
        let limit = if UNIFORM {
            Lanes4::splat(self.square)
        } else {
            let sum = a.add(Lanes4(candidates.supports[k]), Lanes4::splat(place.support));
            let radius = a.scale_add(0.5, sum, Lanes4::splat(self.skin));
            a.mul(radius, radius)
        };
        a.below(square, limit)
    }
}

/// The target of a search: a box, or a point where `half` is zero.
struct SearchBox {
    center: DVec3,
    half: DVec3,
    /// Support radius; zero where it is uniform.
    support: f64,
}

/// Sorted particles in groups of four.
struct CandidateFours<'a, const D: usize> {
    coordinates: [&'a [[f64; 4]]; D],
    supports: &'a [[f64; 4]],
}

/// A column from `first` on, in `fours` groups of four.
#[inline(always)]
fn fours_of<T>(column: &[T], first: usize, fours: usize) -> &[[T; 4]] {
    column[first..first + 4 * fours].as_chunks().0
}

/// Whether a row contains members of several groups.
#[inline(always)]
fn is_mixed(row: &[u32], groups: &[u32]) -> bool {
    let (mut low, mut high) = (u32::MAX, 0);
    for &j in row {
        low = low.min(j);
        high = high.max(j);
    }
    groups.iter().any(|&end| low < end && end <= high)
}
