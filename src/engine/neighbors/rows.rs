//! Rows of a list from a grid, in parallel.
//!
//! Rows are found in waves that bound the memory beside the list, block by block, and copied to their places. Particles that are
//! neighbours in the order of rows share candidates: set-up and sorting see to it that they mostly are near each other.

use super::grid::Grid;
use super::periodic::SHIFT;
use super::{Cloud, NeighborList, Periodic};
use crate::parallel::{Arithmetic, HotLoop, Lanes4, run_hot};
use rayon::prelude::*;
use std::ops::Range;

/// Rows found one after another by one thread.
const BLOCK: usize = 128;
/// Blocks in a wave.
const WAVE: usize = 1024;

/// Memory of one wave, kept from one build to the next.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    blocks: Vec<Block>,
}

/// Rows of one block, one after another.
#[derive(Debug, Default)]
struct Block {
    ends: Vec<usize>,
    /// Longer than what is used: four candidates are written at once, and those kept that are near.
    found: Vec<u32>,
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
    /// Where the groups of the sources end: a row is ordered by groups, and within a group by cells. None for rows in ascending
    /// order.
    pub groups: Option<&'a [u32]>,
}

impl Query<'_> {
    pub(super) fn fill<const PERIODIC: bool, const UNIFORM: bool>(
        &self,
        buffers: &mut Buffers,
        list: &mut NeighborList,
    ) {
        let rows = self.targets.positions.len();
        let blocks = &mut buffers.blocks;
        blocks.resize_with(blocks.len().max(rows.div_ceil(BLOCK).min(WAVE)), Block::default);
        list.offsets.clear();
        list.offsets.push(0);
        list.offsets.reserve(rows);
        for first in (0..rows).step_by(BLOCK * WAVE) {
            let last = (first + BLOCK * WAVE).min(rows);
            let wave = &mut blocks[..(last - first).div_ceil(BLOCK)];
            wave.par_iter_mut().enumerate().for_each(|(b, block)| {
                let start = first + b * BLOCK;
                let rows = start..(start + BLOCK).min(last);
                run_hot(BlockRows::<PERIODIC, UNIFORM> { query: self, rows, block });
            });

            let before = list.offsets[first];
            let mut total = before;
            for block in &*wave {
                list.offsets.extend(block.ends.iter().map(|end| total + end));
                total = list.offsets[list.offsets.len() - 1];
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
            for (part, block) in parts.iter_mut().zip(&*wave) {
                (*part, free) = free.split_at_mut(block.ends.last().copied().unwrap_or(0));
            }
            parts[..wave.len()].par_iter_mut().zip(&*wave).for_each(|(part, block)| {
                part.copy_from_slice(&block.found[..part.len()]);
            });
        }
        list.indices.truncate(list.offsets[rows]);
    }
}

/// The rows of a block.
struct BlockRows<'a, const PERIODIC: bool, const UNIFORM: bool> {
    query: &'a Query<'a>,
    rows: Range<usize>,
    block: &'a mut Block,
}

impl<const PERIODIC: bool, const UNIFORM: bool> HotLoop for BlockRows<'_, PERIODIC, UNIFORM> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self, a: A) {
        let Query { grid, targets, same_set, radius, skin, periodic, groups } = *self.query;
        let Block { ends, found } = self.block;
        let (length, inverse) = (periodic.lengths(), periodic.inverse_lengths());
        let coordinates = grid.coordinates();
        let uniform = Lanes4::splat(radius * radius);
        ends.clear();
        let mut used = 0;
        for i in self.rows {
            let start = used;
            let x_i = targets.positions[i];
            let support_i = if UNIFORM { 0.0 } else { targets.support_of(i) };
            for range in grid.around(x_i).as_slice() {
                let room = used + range.len() + 4;
                if found.len() < room {
                    found.resize(room * 3 / 2, 0);
                }
                for first in range.clone().step_by(4) {
                    let mut square = Lanes4::ZERO;
                    for axis in 0..3 {
                        let mut x = a.minus(four(coordinates[axis], first), Lanes4::splat(x_i[axis]));
                        if PERIODIC {
                            let shift = Lanes4::splat(SHIFT);
                            let turns = a.minus(a.scale_add(inverse[axis], x, shift), shift);
                            x = a.scale_add(-length[axis], turns, x);
                        }
                        square = a.times_add(x, x, square);
                    }
                    let limit = if UNIFORM {
                        uniform
                    } else {
                        let sum = a.plus(four(&grid.supports, first), Lanes4::splat(support_i));
                        let radius = a.scale_add(0.5, sum, Lanes4::splat(skin));
                        a.times(radius, radius)
                    };
                    let inside = (1 << (range.end - first).min(4)) - 1;
                    let near = a.below(square, limit) & inside;
                    let rows = &grid.rows[first..first + 4];
                    let packed = a.pack([rows[0], rows[1], rows[2], rows[3]], near);
                    if let Some(out) = found[used..].first_chunk_mut() {
                        *out = packed;
                    }
                    used += near.count_ones() as usize;
                }
            }
            if same_set && let Some(own) = found[start..used].iter().position(|&j| j == i as u32) {
                found.copy_within(start + own + 1..used, start + own);
                used -= 1;
            }
            let row = &mut found[start..used];
            if groups.is_none_or(|groups| is_mixed(row, groups)) {
                row.sort_unstable();
            }
            ends.push(used);
        }
    }
}

/// Four numbers of a column.
#[inline(always)]
fn four(column: &[f64], first: usize) -> Lanes4 {
    let four = &column[first..first + 4];
    Lanes4([four[0], four[1], four[2], four[3]])
}

/// Whether a row has members of several groups.
#[inline(always)]
fn is_mixed(row: &[u32], groups: &[u32]) -> bool {
    let (mut low, mut high) = (u32::MAX, 0);
    for &j in row {
        low = low.min(j);
        high = high.max(j);
    }
    groups.iter().any(|&end| low < end && end <= high)
}
