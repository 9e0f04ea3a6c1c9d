//! Rows of a list from a grid, in parallel.
//!
//! Rows are found in waves that bound the memory beside the list, block by block, and copied to their places. Particles that are
//! neighbours in the order of rows share candidates: set-up and sorting see to it that they mostly are near each other.

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
    blocks: Vec<Block>,
}

/// Rows of one block, one after another.
#[derive(Debug, Default)]
struct Block {
    ends: Vec<usize>,
    /// Longer than what is used: candidates are written first and kept if they are near.
    found: Vec<u32>,
    excess: Vec<f64>,
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
            let arch = Arch::new();
            wave.par_iter_mut().enumerate().for_each(|(b, block)| {
                let start = first + b * BLOCK;
                arch.dispatch(
                    #[inline(always)]
                    || self.find_rows::<PERIODIC, UNIFORM>(start..(start + BLOCK).min(last), block),
                );
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

    #[inline(always)]
    fn find_rows<const PERIODIC: bool, const UNIFORM: bool>(&self, rows: Range<usize>, block: &mut Block) {
        let Block { ends, found, excess } = block;
        let image = (self.periodic.lengths(), self.periodic.inverse_lengths());
        ends.clear();
        let mut used = 0;
        for i in rows {
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
            let row = &mut found[start..used];
            if self.groups.is_none_or(|groups| is_mixed(row, groups)) {
                row.sort_unstable();
            }
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
