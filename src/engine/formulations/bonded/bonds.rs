//! The bonds of the reference configuration: neighbours, weights, and the inverse moment matrix of every
//! particle.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;
use thiserror::Error;

use super::ellipsoids::Ellipsoids;
use crate::correction::MomentMatrix;
use crate::kernels::Kernel;
use crate::linalg::Sym3;
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic, SupportRadii};
use crate::parallel::{BLOCK, block_count};
use crate::solids::StepEstimate;
use crate::symmetry::Ghosts;

/// Blocks of rows whose bonds are computed before they are put together: enough for all threads, and little
/// memory.
const BLOCKS_AT_ONCE: usize = 256;

/// Rows whose stable steps one task finds.
const ROWS_OF_TASK: usize = 1024;

/// Why the bonds of a body cannot be computed.
#[derive(Debug, Error)]
pub enum BondError {
    /// The neighbour search failed.
    #[error(transparent)]
    Search(#[from] NeighborError),
    /// Every particle is free: the body has no stiffness at all.
    #[error(
        "no particle of the body has enough neighbours for a deformation gradient (at most {most} neighbours)"
    )]
    NoStiffness {
        /// Largest number of neighbours.
        most: usize,
    },
}

/// The bonds of all total-Lagrangian bodies; rows are rows of the phase.
#[derive(Debug, Default)]
pub struct Bonds {
    /// Where the neighbours of each row start.
    pub(in crate::formulations) offsets: Arc<Vec<u32>>,
    /// Row of the neighbour; rows beyond the last particle are ghosts (see [`Ghosts`]).
    pub(in crate::formulations) neighbors: Arc<Vec<u32>>,
    /// Pair weight w_ij = |W'(|X_ij|)| / |X_ij|. In single precision: M_i is built from the rounded weight,
    /// so the deformation gradient of an affine map stays exact.
    pub(in crate::formulations) weights: Vec<f32>,
    /// Inverse of M_i = sum_j V_j w_ij X_ij (x) X_ij; zero for a free particle.
    pub(in crate::formulations) inverse_moment: Vec<Sym3>,
    /// `sum_j V_j w_ij X_ij`.
    pub(in crate::formulations) first_moment: Vec<DVec3>,
    /// `sum_j V_j w_ij`, 1/m2.
    pub(in crate::formulations) weight_sum: Vec<f64>,
    /// Particles that have too few neighbours for a deformation gradient; they carry no stress.
    pub(in crate::formulations) free: Vec<u32>,
    /// Share of its stress that every row carries: that of the part of its cell which is not held. Empty
    /// where all carry all of it.
    pub(in crate::formulations) carried: Vec<f64>,
}

/// The reference configuration of one body.
pub(in crate::formulations) struct BodyBonds<'a> {
    /// Rows of the body in the phase.
    pub rows: Range<usize>,
    /// Reference positions of the whole phase, m.
    pub position: &'a [DVec3],
    /// Reference volumes of the whole phase, m3.
    pub volume: &'a [f64],
    /// Support radii of the whole phase, m.
    pub support: &'a [f64],
    /// Kernel.
    pub kernel: Kernel,
    /// Ghosts of the bodies.
    pub ghosts: &'a Ghosts,
    /// Rows of the ghosts of this body.
    pub ghost_rows: Range<usize>,
    /// Particles that no other one sees, by their numbers in the body, ascending.
    pub hidden: &'a [u32],
}

/// The bonds of some rows.
#[derive(Default)]
struct RowBonds {
    /// Where those of each row end.
    ends: Vec<usize>,
    neighbors: Vec<u32>,
    weights: Vec<f32>,
}

impl BodyBonds<'_> {
    /// Neighbours of the rows of the body, in the body and its ghosts, numbered from zero.
    fn neighbors(&self, search: &mut NeighborSearch) -> Result<NeighborList, NeighborError> {
        let mut list = NeighborList::default();
        let mut find = |positions: &[DVec3], support: &[f64]| {
            let cloud = Cloud { positions, support: SupportRadii::PerParticle(support) };
            search.within(cloud, 0.0, &Periodic::NONE, &mut list)
        };
        let (position, support) = (&self.position[self.rows.clone()], &self.support[self.rows.clone()]);
        if self.ghost_rows.is_empty() {
            find(position, support)?;
        } else {
            let places = self.ghost_rows.clone().map(|row| self.ghosts.place(self.position, row));
            let sources = self.ghost_rows.clone().map(|row| self.ghosts.source(row));
            let position: Vec<DVec3> = position.iter().copied().chain(places).collect();
            let support: Vec<f64> = self.rows.clone().chain(sources).map(|row| self.support[row]).collect();
            find(&position, &support)?;
        }
        Ok(list)
    }

    /// Whether a particle is seen, by its number in [`BodyBonds::neighbors`].
    fn is_seen(&self, number: u32) -> bool {
        let own = match (number as usize).checked_sub(self.rows.len()) {
            None => number,
            Some(ghost) => (self.ghosts.source(self.ghost_rows.start + ghost) - self.rows.start) as u32,
        };
        self.hidden.binary_search(&own).is_err()
    }

    /// Weight of the bond from row `i` to row `j`.
    fn weight(&self, i: usize, j: usize) -> f32 {
        let distance = self.ghosts.pair(self.position, i, j).length();
        let support = 0.5 * (self.support[i] + self.support[self.ghosts.source(j)]);
        self.kernel.pair_weight(distance, support * self.kernel.smoothing_length(1.0)) as f32
    }

    /// Neighbours and weights of some rows, by their numbers in the body.
    fn bonds_of(&self, rows: Range<usize>, list: &NeighborList, is_seen: &[bool]) -> RowBonds {
        let mut bonds = RowBonds::default();
        for k in rows {
            if is_seen[k] {
                for j in list.row(k).iter().filter(|&&j| is_seen[j as usize]).map(|&j| self.row(j)) {
                    bonds.neighbors.push(j);
                    bonds.weights.push(self.weight(self.rows.start + k, j as usize));
                }
            }
            bonds.ends.push(bonds.neighbors.len());
        }
        bonds
    }

    /// The row of the phase that a number of [`BodyBonds::neighbors`] means.
    fn row(&self, number: u32) -> u32 {
        let number = number as usize;
        let row = match number.checked_sub(self.rows.len()) {
            None => self.rows.start + number,
            Some(ghost) => self.ghost_rows.start + ghost,
        };
        u32::try_from(row).unwrap_or(u32::MAX)
    }
}

impl Bonds {
    /// Appends the bonds of the next body; bodies must come in the order of their rows.
    pub(in crate::formulations) fn append(
        &mut self,
        body: &BodyBonds<'_>,
        search: &mut NeighborSearch,
    ) -> Result<(), BondError> {
        let rows = body.rows.clone();
        let list = body.neighbors(search)?;
        if self.offsets.is_empty() {
            Arc::make_mut(&mut self.offsets).push(0);
        }
        let numbers = 0..(rows.len() + body.ghost_rows.len()) as u32;
        let is_seen: Vec<bool> = numbers.map(|number| body.is_seen(number)).collect();
        let blocks = block_count(rows.len());
        for group in (0..blocks).step_by(BLOCKS_AT_ONCE) {
            let made = (group..blocks.min(group + BLOCKS_AT_ONCE)).into_par_iter().map(|block| {
                let first = block * BLOCK;
                body.bonds_of(first..rows.len().min(first + BLOCK), &list, &is_seen)
            });
            made.collect::<Vec<_>>().iter().for_each(|bonds| self.extend(bonds));
        }
        self.correct(rows.clone(), body.kernel.dimension(), body.position, body.volume, body.ghosts);
        let free = self.free.iter().filter(|&&row| rows.contains(&(row as usize))).count();
        if free == rows.len() {
            return Err(BondError::NoStiffness { most: list.max_count() });
        }
        Ok(())
    }

    fn extend(&mut self, next: &RowBonds) {
        self.add_neighbors(&next.ends, &next.neighbors);
        self.weights.extend_from_slice(&next.weights);
    }

    /// Appends the neighbours of some rows, each of which ends there.
    pub(in crate::formulations) fn add_neighbors(&mut self, ends: &[usize], neighbors: &[u32]) {
        let start = self.neighbors.len();
        let offset = |end: &usize| u32::try_from(start + end).unwrap_or(u32::MAX);
        Arc::make_mut(&mut self.offsets).extend(ends.iter().map(offset));
        Arc::make_mut(&mut self.neighbors).extend_from_slice(neighbors);
    }

    /// Lets go of neighbours that are shared.
    pub(in crate::formulations) fn leave_topology(&mut self) {
        (self.offsets, self.neighbors) = Default::default();
    }

    /// Lets go of all bonds; memory is kept where no others share the neighbours.
    pub(in crate::formulations) fn clear(&mut self) {
        let Self { offsets, neighbors, weights, inverse_moment, first_moment, weight_sum, free, carried: _ } =
            self;
        for list in [offsets, neighbors] {
            match Arc::get_mut(list) {
                Some(list) => list.clear(),
                None => *list = Arc::default(),
            }
        }
        weights.clear();
        inverse_moment.clear();
        first_moment.clear();
        weight_sum.clear();
        free.clear();
    }

    /// Lists which of some rows, the next ones, are free; returns how many.
    pub(in crate::formulations) fn list_free(&mut self, rows: &Range<usize>) -> usize {
        let before = self.free.len();
        let inverse = &self.inverse_moment;
        let is_free = |row: &usize| inverse[*row] == Sym3::ZERO;
        self.free.extend(rows.clone().filter(is_free).map(|row| u32::try_from(row).unwrap_or(u32::MAX)));
        self.free.len() - before
    }

    /// Makes the moment matrices of the given rows; a neighbour without volume has no part in them, and a row
    /// without volume has none.
    pub(in crate::formulations) fn correct(
        &mut self,
        rows: Range<usize>,
        dimension: usize,
        position: &[DVec3],
        volume: &[f64],
        ghosts: &Ghosts,
    ) {
        let corrected: Vec<(Option<Sym3>, DVec3, f64)> = rows
            .clone()
            .into_par_iter()
            .map(|i| {
                let mut moment = MomentMatrix::new(dimension);
                let (mut first_moment, mut weight_sum) = (DVec3::ZERO, 0.0);
                for (j, weight) in self.row(i) {
                    let volume_weight = volume[ghosts.source(j)] * f64::from(weight);
                    let x_ij = ghosts.pair(position, i, j);
                    moment.add(volume_weight, x_ij);
                    first_moment += x_ij * volume_weight;
                    weight_sum += volume_weight;
                }
                (moment.inverse().filter(|_| volume[i] > 0.0), first_moment, weight_sum)
            })
            .collect();
        self.inverse_moment.resize(self.inverse_moment.len().max(rows.end), Sym3::ZERO);
        self.first_moment.resize(self.inverse_moment.len(), DVec3::ZERO);
        self.weight_sum.resize(self.inverse_moment.len(), 0.0);
        self.free.retain(|&row| !rows.contains(&(row as usize)));
        for (i, (inverse, first_moment, weight_sum)) in rows.zip(corrected) {
            if inverse.is_none() {
                self.free.push(u32::try_from(i).unwrap_or(u32::MAX));
            }
            self.inverse_moment[i] = inverse.unwrap_or_default();
            self.first_moment[i] = first_moment;
            self.weight_sum[i] = weight_sum;
        }
    }

    /// The smallest stable step of the given rows, s.
    pub(in crate::formulations) fn stable_step(
        &self,
        rows: Range<usize>,
        axes: usize,
        estimate: &StepEstimate,
        support: &[f64],
        ellipsoids: Option<Ellipsoids<'_>>,
    ) -> f64 {
        let step = |i: usize, trace: f64| {
            let sum = self.weight_sum[i];
            estimate.stable_step_with(sum, trace / axes as f64, 0.5 * support[i] * sum)
        };
        let smaller = |least: f64, i: usize| {
            let inverse = &self.inverse_moment[i];
            let own = match ellipsoids.map(|all| &all.0[i]) {
                None => step(i, inverse.trace()),
                // Few particles need their shortest axis.
                Some(own) if step(i, own.trace(inverse, own.axis_bound())) >= least => return least,
                Some(own) => step(i, own.trace(inverse, own.shortest())),
            };
            if own.is_finite() { least.min(own) } else { least }
        };
        let steps = rows.into_par_iter().with_min_len(ROWS_OF_TASK).fold(|| f64::INFINITY, smaller);
        steps.reduce(|| f64::INFINITY, f64::min)
    }

    /// Neighbours and weights of a row; neighbours beyond the last particle are ghosts (see [`Ghosts`]).
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
        let bonds = self.offsets[i] as usize..self.offsets[i + 1] as usize;
        self.neighbors[bonds.clone()].iter().map(|&j| j as usize).zip(self.weights[bonds].iter().copied())
    }

    /// Makes a particle free.
    pub(in crate::formulations) fn release(&mut self, row: usize) {
        self.inverse_moment[row] = Sym3::ZERO;
        self.free.push(u32::try_from(row).unwrap_or(u32::MAX));
    }

    /// Shares the neighbours of other bonds, with capacity for weights and moments, which have to be given.
    pub(in crate::formulations) fn share_topology(&mut self, other: &Self) {
        self.offsets = Arc::clone(&other.offsets);
        self.neighbors = Arc::clone(&other.neighbors);
        self.weights.resize(other.weights.len(), 0.0);
        let rows = other.inverse_moment.len();
        self.inverse_moment.resize(rows, Sym3::ZERO);
        self.first_moment.resize(rows, DVec3::ZERO);
        self.weight_sum.resize(rows, 0.0);
        self.free.clear();
    }

    /// Number of directed bonds.
    pub fn len(&self) -> usize {
        self.neighbors.len()
    }

    /// Whether there is no bond.
    pub fn is_empty(&self) -> bool {
        self.neighbors.is_empty()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.offsets.len() * 4
            + self.neighbors.len() * 8
            + self.inverse_moment.len() * (size_of::<Sym3>() + size_of::<DVec3>() + size_of::<f64>())
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::super::ellipsoids::Ellipsoid;
    use super::*;

    #[test]
    fn the_stable_step_is_the_smallest_of_all_particles_whichever_need_their_shortest_axis() {
        let wave = |k: usize, a: f64| (a * k as f64 + 0.3).sin();
        let count = 3000;
        let strain = |k: usize| {
            let (a, b, c) = (wave(k, 0.7), wave(k, 1.9), wave(k, 0.13));
            DMat3::from_diagonal(DVec3::new(1.0 + 0.4 * a, 1.0 + 0.3 * b, 1.0 - 0.2 * c))
        };
        let ellipsoids: Vec<Ellipsoid> =
            (0..count).map(|k| Ellipsoid::new(Ellipsoid::following(&strain(k)))).collect();
        let inverse = |k: usize| match k % 100 {
            7 => Sym3::ZERO,
            _ => {
                Sym3 { xx: 1.2, yy: 1.0 + 0.1 * wave(k, 0.4), zz: 0.9, xy: 0.1 * wave(k, 2.3), ..Sym3::ZERO }
            }
        };
        let bonds = Bonds {
            inverse_moment: (0..count).map(inverse).collect(),
            weight_sum: (0..count).map(|k| 1e4 * (1.0 + 0.2 * wave(k, 0.05))).collect(),
            ..Bonds::default()
        };
        let (estimate, support) = (StepEstimate { wave: 1e6, bond: 0.0, hessian: 0.0 }, vec![0.1; count]);
        let all = Some(Ellipsoids(&ellipsoids));
        let found = bonds.stable_step(0..count, 3, &estimate, &support, all);
        let step = |k: usize| {
            let (own, sum) = (&ellipsoids[k], bonds.weight_sum[k]);
            let felt = own.trace(&bonds.inverse_moment[k], own.shortest());
            estimate.stable_step_with(sum, felt / 3.0, 0.05 * sum)
        };
        let least = (0..count).map(step).filter(|step| step.is_finite()).fold(f64::INFINITY, f64::min);
        assert!(found > 0.0 && found == least, "{found} for {least}");
    }
}
