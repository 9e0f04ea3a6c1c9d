//! Building a list from a grid.

use super::grid::Grid;
use super::periodic::AXIS_NAMES;
use super::{Cloud, NeighborError, NeighborList, Periodic, Support};
use glam::DVec3;
use rayon::prelude::*;

/// Rows found one after another by one thread.
const BLOCK: usize = 128;
/// Blocks that are found in parallel before they are copied into the list: bounds the memory beside the list.
const WAVE: usize = 512;

/// Neighbour search with buffers that are kept: from the second build of like size on it does not allocate.
#[derive(Debug, Default)]
pub struct NeighborSearch {
    grid: Grid,
    blocks: Vec<Block>,
}

/// Rows of one block, one after another.
#[derive(Debug, Default)]
struct Block {
    ends: Vec<usize>,
    /// Longer than what is used: rows are written without a test of the length in the loop over candidates.
    found: Vec<u32>,
}

impl Block {
    fn used(&self) -> usize {
        self.ends.last().copied().unwrap_or(0)
    }
}

impl NeighborSearch {
    /// Lists the neighbours of every particle of `cloud` in `cloud`, itself excluded, within the mean of their
    /// support radii plus `skin` [m]. What `list` held is replaced.
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn within(
        &mut self,
        cloud: Cloud<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        self.build(cloud, cloud, true, skin, periodic, list)
    }

    /// Lists the neighbours of every target among `sources`, another set of particles: equal row numbers are not
    /// the same particle. Otherwise as [`NeighborSearch::within`].
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn between(
        &mut self,
        targets: Cloud<'_>,
        sources: Cloud<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        self.build(targets, sources, false, skin, periodic, list)
    }

    fn build(
        &mut self,
        targets: Cloud<'_>,
        sources: Cloud<'_>,
        same_set: bool,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        if !(skin >= 0.0 && skin.is_finite()) {
            return Err(NeighborError::Skin(skin));
        }
        targets.check("target")?;
        if !same_set {
            sources.check("source")?;
        }
        let radius = 0.5 * (targets.largest_support() + sources.largest_support()) + skin;
        for a in (0..3).filter(|&a| periodic.axes()[a]) {
            let (length, needed) = (periodic.lengths()[a], 2.0 * radius);
            if length < needed {
                return Err(NeighborError::PeriodicTooShort { axis: AXIS_NAMES[a], length, needed });
            }
        }
        let mut bounds = sources.bounds();
        if !same_set && periodic.any() {
            let more = targets.bounds();
            for a in (0..3).filter(|&a| periodic.axes()[a]) {
                bounds.0[a] = bounds.0[a].min(more.0[a]);
                bounds.1[a] = bounds.1[a].max(more.1[a]);
            }
        }
        let uniform =
            matches!((targets.support, sources.support), (Support::Uniform(_), Support::Uniform(_)));
        self.grid.build(sources, !uniform, bounds, radius, periodic);

        let query = Query { grid: &self.grid, targets, same_set, radius, skin, periodic };
        match (periodic.any(), uniform) {
            (false, true) => query.fill::<false, true>(&mut self.blocks, list),
            (false, false) => query.fill::<false, false>(&mut self.blocks, list),
            (true, true) => query.fill::<true, true>(&mut self.blocks, list),
            (true, false) => query.fill::<true, false>(&mut self.blocks, list),
        }
        Ok(())
    }
}

struct Query<'a> {
    grid: &'a Grid,
    targets: Cloud<'a>,
    same_set: bool,
    /// Largest pair radius, skin included.
    radius: f64,
    skin: f64,
    periodic: &'a Periodic,
}

impl Query<'_> {
    fn fill<const PERIODIC: bool, const UNIFORM: bool>(
        &self,
        blocks: &mut Vec<Block>,
        list: &mut NeighborList,
    ) {
        let rows = self.targets.positions.len();
        let wave_rows = BLOCK * WAVE;
        blocks.resize_with(blocks.len().max(rows.div_ceil(BLOCK).min(WAVE)), Block::default);
        list.offsets.clear();
        list.offsets.push(0);
        list.offsets.reserve(rows);
        let mut total = 0;
        for first in (0..rows).step_by(wave_rows) {
            let last = (first + wave_rows).min(rows);
            let wave = &mut blocks[..(last - first).div_ceil(BLOCK)];
            wave.par_iter_mut().enumerate().for_each(|(b, block)| {
                let start = first + b * BLOCK;
                self.find_rows::<PERIODIC, UNIFORM>(start..(start + BLOCK).min(last), block);
            });

            let before = total;
            for block in wave.iter() {
                list.offsets.extend(block.ends.iter().map(|end| total + end));
                total += block.used();
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
            for (part, block) in parts.iter_mut().zip(wave.iter()) {
                let (head, tail) = free.split_at_mut(block.used());
                (*part, free) = (head, tail);
            }
            parts[..wave.len()]
                .par_iter_mut()
                .zip(&*wave)
                .for_each(|(part, block)| part.copy_from_slice(&block.found[..block.used()]));
        }
        list.indices.truncate(total);
    }

    fn find_rows<const PERIODIC: bool, const UNIFORM: bool>(
        &self,
        rows: std::ops::Range<usize>,
        block: &mut Block,
    ) {
        block.ends.clear();
        let mut used = 0;
        for i in rows {
            let start = used;
            let x_i = self.targets.positions[i];
            let support_i = self.targets.support_of(i);
            let own_row = if self.same_set { i as u32 } else { u32::MAX };
            self.grid.around(x_i, |range| {
                if block.found.len() < used + range.len() {
                    block.found.resize((used + range.len()) * 3 / 2, 0);
                }
                let supports = if UNIFORM { &[][..] } else { &self.grid.supports[range.clone()] };
                let sorted = self.grid.positions[range.clone()].iter().zip(&self.grid.rows[range]);
                for (k, (x_j, &j)) in sorted.enumerate() {
                    let mut x_ij = DVec3::from_array(*x_j) - x_i;
                    if PERIODIC {
                        x_ij = self.periodic.minimal_image(x_ij);
                    }
                    let radius =
                        if UNIFORM { self.radius } else { 0.5 * (support_i + supports[k]) + self.skin };
                    block.found[used] = j;
                    used += usize::from((x_ij.length_squared() < radius * radius) & (j != own_row));
                }
            });
            block.found[start..used].sort_unstable();
            block.ends.push(used);
        }
    }
}
