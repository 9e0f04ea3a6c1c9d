//! Neighbours, weights and moments of a reference, built from lists of candidates.
//!
//! Everything is done block by block in buffers that are kept from one update to the next: particles within
//! the largest radius, those within the ellipsoids, weights at their distances, and moments of the rounded
//! weights. The stabilizers have the same neighbours with other weights, at the lengths of the original pair
//! vectors mapped by the deformation, and moments of the original pair vectors.

use std::ops::Range;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::candidates::{Candidates, Searched, largest, radii};
use super::row_loops::{Corrections, MeasurePairs, PairBlock, PairOrigin, RowPairs, Weights};
use super::seen::{Columns, SeenParticles, fill_columns};
use crate::formulations::bonded::{BondError, Bonds, Ellipsoid};
use crate::kernels::Kernel;
use crate::neighbors::NeighborSearch;
use crate::parallel::{BLOCK, block_count, run_hot_on};
use crate::symmetry::Ghosts;

/// Blocks of rows that each thread makes before they are put together: so few that they stay in its
/// second-level cache until then.
const BLOCKS_AT_ONCE: usize = 8;
/// Rows of a part of a block.
const PART: usize = 16;

/// Buffers kept from one update to the next.
#[derive(Default)]
pub(super) struct ReferenceLists {
    /// Of every body.
    candidates: Vec<Candidates>,
    search: NeighborSearch,
    radii: Vec<f64>,
    seen: SeenParticles,
    columns: Vec<Columns>,
    blocks: Vec<PairBlock>,
}

/// The reference of all bodies of a phase.
#[derive(Clone, Copy)]
pub(super) struct ReferenceOfPhase<'a> {
    /// Places, m.
    pub places: &'a [DVec3],
    /// Volumes, m3.
    pub volumes: &'a [f64],
    /// Support radii, m.
    pub support: &'a [f64],
    pub ellipsoids: &'a [Ellipsoid],
    pub ghosts: &'a Ghosts,
}

/// A body.
#[derive(Clone)]
pub(super) struct UpdatedBody<'a> {
    /// Number of the body in its formulation.
    pub body: usize,
    pub rows: Range<usize>,
    pub ghost_rows: Range<usize>,
    pub kernel: Kernel,
    /// Particles that no other one sees, by their numbers in the body, ascending.
    pub hidden: &'a [u32],
}

impl ReferenceLists {
    /// Begins a reference of bodies with these rows.
    pub fn begin(&mut self, reference: &ReferenceOfPhase<'_>, bodies: impl Iterator<Item = Range<usize>>) {
        let ReferenceOfPhase { places, volumes, support, ellipsoids, ghosts } = *reference;
        self.seen.fill(ghosts, ellipsoids, support, places, volumes);
        self.radii.clear();
        let mut count = 0;
        for rows in bodies {
            radii(&support[rows.clone()], &ellipsoids[rows], &mut self.radii);
            count += 1;
        }
        self.candidates.resize_with(count, Candidates::default);
    }

    /// Appends the bonds of the next body; bodies must come in the order of their rows.
    pub fn append(
        &mut self,
        reference: &ReferenceOfPhase<'_>,
        body: &UpdatedBody<'_>,
        bonds: &mut Bonds,
    ) -> Result<(), BondError> {
        let UpdatedBody { body, rows, ghost_rows, kernel, hidden } = body.clone();
        let Self { candidates, search, radii, seen, blocks, .. } = self;
        let searched = Searched { places: reference.places, radii, ghosts: reference.ghosts, hidden };
        let candidates = &mut candidates[body];
        let list = candidates.renewed(rows.clone(), ghost_rows, &searched, search)?;
        let square = largest(&radii[rows.clone()]).powi(2);
        let source = PairOrigin::Near { list, first: rows.start, square };
        let pairs = RowPairs { seen, source };
        if bonds.offsets.is_empty() {
            bonds.add_neighbors(&[0], &[]);
        }
        in_waves(&pairs, &rows, &kernel, blocks, |block| append(bonds, block));
        candidates.rest();
        // The last particles of a body that leaves the domain have no neighbours any more.
        let is_whole = rows.clone().all(|row| reference.volumes[row] > 0.0);
        if bonds.list_free(&rows) == rows.len() && is_whole {
            let most = rows.map(|row| bonds.row(row).count()).max().unwrap_or(0);
            return Err(BondError::NoStiffness { most });
        }
        Ok(())
    }

    /// Begins the bonds of the stabilizers, with original places, m, volumes, m3, and F_r, each to be
    /// multiplied by its `scale`.
    pub fn begin_control(
        &mut self,
        original: &[DVec3],
        volumes: &[f64],
        gradient: &[DMat3],
        scale: impl Fn(usize) -> f64 + Sync,
        ghosts: &Ghosts,
    ) {
        self.seen.place(ghosts, original, volumes);
        fill_columns(&mut self.columns, ghosts, gradient, scale);
    }

    /// Gives the bonds of the stabilizers of some rows, whose neighbours are there already, weights and
    /// moments.
    pub fn weigh_control(&mut self, rows: &Range<usize>, kernel: &Kernel, bonds: &mut Bonds) {
        let Self { seen, columns, blocks, .. } = self;
        let Bonds { offsets, neighbors, weights, inverse_moment, first_moment, weight_sum, .. } = bonds;
        let source = PairOrigin::Known { offsets, neighbors, columns };
        let pairs = RowPairs { seen, source };
        let mut row = rows.start;
        in_waves(&pairs, rows, kernel, blocks, |block| {
            let first = offsets[row] as usize;
            weights[first..first + block.len()].copy_from_slice(&block.weights[..block.len()]);
            for correction in &block.corrections {
                inverse_moment[row] = correction.inverse;
                first_moment[row] = correction.first_moment;
                weight_sum[row] = correction.weight_sum;
                row += 1;
            }
        });
        bonds.list_free(rows);
    }
}

/// Appends the rows of a block.
fn append(bonds: &mut Bonds, block: &PairBlock) {
    bonds.add_neighbors(&block.ends, &block.neighbors[..block.len()]);
    bonds.weights.extend_from_slice(&block.weights[..block.len()]);
    for correction in &block.corrections {
        bonds.inverse_moment.push(correction.inverse);
        bonds.first_moment.push(correction.first_moment);
        bonds.weight_sum.push(correction.weight_sum);
    }
}

/// Makes rows block by block, on all threads, and gives the blocks to `take` in their order.
fn in_waves(
    pairs: &RowPairs<'_>,
    rows: &Range<usize>,
    kernel: &Kernel,
    blocks: &mut Vec<PairBlock>,
    mut take: impl FnMut(&PairBlock),
) {
    let (count, plane) = (block_count(rows.len()), kernel.dimension() == 2);
    let at_once = BLOCKS_AT_ONCE * rayon::current_num_threads();
    blocks.resize_with(blocks.len().max(count.min(at_once)), PairBlock::default);
    for group in (0..count).step_by(at_once) {
        let wave = &mut blocks[..(count - group).min(at_once)];
        wave.par_iter_mut().enumerate().for_each(|(k, block)| {
            let first = rows.start + (group + k) * BLOCK;
            let end = rows.end.min(first + BLOCK);
            block.clear();
            for first in (first..end).step_by(PART) {
                let rows = first..end.min(first + PART);
                run_hot_on(plane, MeasurePairs { pairs, rows: rows.clone(), block: &mut *block });
                kernel.dispatch(Weights(&mut *block));
                run_hot_on(plane, Corrections { pairs, rows, block: &mut *block });
            }
        });
        wave.iter().for_each(&mut take);
    }
}
