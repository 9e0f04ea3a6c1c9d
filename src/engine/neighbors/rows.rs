//! Rows of a list from a grid, in parallel.
//!
//! Rows are found in waves that bound the memory beside the list. Within a wave they are found in the order of cells,
//! so that particles that share candidates follow each other whatever the order of rows, and copied to their places.

use super::grid::Grid;
use super::periodic::nearest_integer;
use super::{Cloud, NeighborList, Periodic};
use glam::DVec3;
use pulp::Arch;
use rayon::prelude::*;
use std::ops::Range;

/// Rows found one after another by one thread.
const BLOCK: usize = 128;
/// Blocks in a wave.
const WAVE: usize = 1024;

/// Memory of one wave, kept from one build to the next.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    /// Bucket (upper half) and row within the wave (lower half), sorted.
    order: Vec<u64>,
    /// Place of each row of the wave in `order`.
    places: Vec<u32>,
    blocks: Vec<Block>,
}

/// Rows of one block, one after another, in the order of cells.
#[derive(Debug, Default)]
struct Block {
    ends: Vec<usize>,
    /// Longer than what is used: candidates are written first and kept if they are near.
    found: Vec<u32>,
    excess: Vec<f64>,
}

impl Block {
    fn range(&self, k: usize) -> Range<usize> {
        let start = if k == 0 { 0 } else { self.ends[k - 1] };
        start..self.ends[k]
    }
}

/// What a build looks for.
pub(super) struct Query<'a> {
    pub grid: &'a Grid,
    pub targets: Cloud<'a>,
    pub same_set: bool,
    /// Largest pair radius (m), skin included.
    pub radius: f64,
    pub skin: f64,
    pub periodic: &'a Periodic,
}

impl Query<'_> {
    pub(super) fn fill<const PERIODIC: bool, const UNIFORM: bool>(
        &self,
        buffers: &mut Buffers,
        list: &mut NeighborList,
    ) {
        let rows = self.targets.positions.len();
        let Buffers { order, places, blocks } = buffers;
        blocks.resize_with(blocks.len().max(rows.div_ceil(BLOCK).min(WAVE)), Block::default);
        list.offsets.clear();
        list.offsets.push(0);
        list.offsets.reserve(rows);
        for first in (0..rows).step_by(BLOCK * WAVE) {
            let last = (first + BLOCK * WAVE).min(rows);
            self.sort_by_cell(first..last, order, places);
            let wave = &mut blocks[..(last - first).div_ceil(BLOCK)];
            let arch = Arch::new();
            wave.par_iter_mut().zip(order.par_chunks(BLOCK)).for_each(|(block, order)| {
                arch.dispatch(
                    #[inline(always)]
                    || self.find_rows::<PERIODIC, UNIFORM>(first, order, block),
                );
            });

            let found = |row: usize| {
                let place = places[row - first] as usize;
                let block = &wave[place / BLOCK];
                &block.found[block.range(place % BLOCK)]
            };
            let before = list.offsets[first];
            let mut total = before;
            for row in first..last {
                total += found(row).len();
                list.offsets.push(total);
            }
            if list.indices.len() < total {
                if list.indices.capacity() < total {
                    let expected = (total as f64 / last as f64 * rows as f64 * 1.02) as usize;
                    list.indices.reserve_exact(expected.max(total) - list.indices.len());
                }
                list.indices.resize(total, 0);
            }
            let mut free = &mut list.indices[before..total];
            let mut parts: [&mut [u32]; WAVE] = std::array::from_fn(|_| &mut [][..]);
            for (part, start) in parts.iter_mut().zip((first..last).step_by(BLOCK)) {
                let pairs = list.offsets[(start + BLOCK).min(last)] - list.offsets[start];
                (*part, free) = free.split_at_mut(pairs);
            }
            parts[..wave.len()].par_iter_mut().enumerate().for_each(|(b, part)| {
                let start = first + b * BLOCK;
                let mut at = 0;
                for row in start..(start + BLOCK).min(last) {
                    let row = found(row);
                    part[at..at + row.len()].copy_from_slice(row);
                    at += row.len();
                }
            });
        }
        list.indices.truncate(list.offsets[rows]);
    }

    fn sort_by_cell(&self, rows: Range<usize>, order: &mut Vec<u64>, places: &mut Vec<u32>) {
        order.resize(rows.len(), 0);
        order
            .par_iter_mut()
            .with_min_len(4096)
            .zip(&self.targets.positions[rows.clone()])
            .enumerate()
            .for_each(|(k, (key, position))| *key = u64::from(self.grid.key(*position)) << 32 | k as u64);
        order.par_sort_unstable();
        places.resize(rows.len(), 0);
        for (place, key) in order.iter().enumerate() {
            places[*key as u32 as usize] = place as u32;
        }
    }

    #[inline(always)]
    fn find_rows<const PERIODIC: bool, const UNIFORM: bool>(
        &self,
        first: usize,
        order: &[u64],
        block: &mut Block,
    ) {
        let Block { ends, found, excess } = block;
        let image = (self.periodic.lengths(), self.periodic.inverse_lengths());
        ends.clear();
        let mut used = 0;
        for key in order {
            let i = first + *key as u32 as usize;
            let start = used;
            let x_i = self.targets.positions[i];
            let own_row = if self.same_set { i as u32 } else { u32::MAX };
            self.grid.around(
                x_i,
                #[inline(always)]
                |range| {
                    let count = range.len();
                    if found.len() < used + count {
                        found.resize((used + count) * 3 / 2, 0);
                    }
                    if excess.len() < count {
                        excess.resize(count * 3 / 2, 0.0);
                    }
                    let excess = &mut excess[..count];
                    if UNIFORM {
                        let limit = self.radius * self.radius;
                        self.distances::<PERIODIC>(x_i, image, range.clone(), excess, |_| limit);
                    } else {
                        let support_i = self.targets.support_of(i);
                        let supports = &self.grid.supports[range.clone()];
                        self.distances::<PERIODIC>(x_i, image, range.clone(), excess, |k| {
                            let radius = 0.5 * (support_i + supports[k]) + self.skin;
                            radius * radius
                        });
                    }
                    let into = &mut found[used..used + count];
                    let mut kept = 0;
                    for (&j, &excess) in self.grid.rows[range].iter().zip(&*excess) {
                        into[kept] = j;
                        kept += usize::from((excess < 0.0) & (j != own_row));
                    }
                    used += kept;
                },
            );
            found[start..used].sort_unstable();
            ends.push(used);
        }
    }

    /// Squared distances of candidates less the square of the pair radius: a loop without branches, for the vector unit.
    #[inline(always)]
    fn distances<const PERIODIC: bool>(
        &self,
        x_i: DVec3,
        (length, inverse_length): (DVec3, DVec3),
        range: Range<usize>,
        excess: &mut [f64],
        limit: impl Fn(usize) -> f64,
    ) {
        let [x, y, z] = self.grid.coordinates(range);
        let count = excess.len();
        let (x, y, z) = (&x[..count], &y[..count], &z[..count]);
        for k in 0..count {
            let (mut dx, mut dy, mut dz) = (x[k] - x_i.x, y[k] - x_i.y, z[k] - x_i.z);
            if PERIODIC {
                dx -= length.x * nearest_integer(dx * inverse_length.x);
                dy -= length.y * nearest_integer(dy * inverse_length.y);
                dz -= length.z * nearest_integer(dz * inverse_length.z);
            }
            excess[k] = dx * dx + dy * dy + dz * dz - limit(k);
        }
    }
}
