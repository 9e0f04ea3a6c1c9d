//! The neighbours of a particle, four at a time.

use std::ops::Range;

use super::flow_cloud::FlowCloud;
use super::row_pass::NearPairs;
use crate::formulations::fluid::lanes::{FILLS, FourPlaces, as_rows, filled_up};
use crate::formulations::fluid::lists::blocks::Blocks;
use crate::parallel::{FourLanes, Number, Vector};

/// Four neighbours of a particle, of one body. Lanes without a neighbour repeat one.
#[derive(Clone, Copy)]
pub struct FourNear<A: FourLanes> {
    /// Rows of the cloud.
    pub rows: [usize; 4],
    /// Reads of the pass.
    pub pairs: NearPairs<A>,
}

impl FlowCloud {
    /// The neighbours of particle `i` within the support: rows of the cloud, ordered by bodies. With sums in
    /// single precision they may hold the particle itself, and others beyond the support; of particles that
    /// other ranks compute, all that is near their blocks.
    #[inline(always)]
    pub(in crate::formulations::fluid) fn near_row(&self, i: usize) -> &[u32] {
        let blocks = self.blocks.as_ref();
        if let Some((blocks, block)) = blocks.and_then(|blocks| Some((blocks, blocks.shared_block(i)?))) {
            return match blocks.lists.others.is_own(block) {
                true => blocks.near.row(block),
                false => self.pairs.row_of_others(&blocks.lists, block),
            };
        }
        match i.checked_sub(self.fluid) {
            Some(row) => self.near_boundary.row(row),
            None => self.near.row(i),
        }
    }

    /// The particles of a boundary near fluid particle `i`: at least those within the support, of particles
    /// that other ranks compute as well.
    pub(in crate::formulations::fluid) fn boundary_near(&self, i: usize, boundary: &Range<usize>) -> &[u32] {
        let of_other =
            |blocks: &Blocks| blocks.shared_block(i).is_some_and(|block| !blocks.lists.others.is_own(block));
        match self.blocks.as_deref().is_some_and(of_other) {
            true => part(self.pairs.walls.row(i), boundary),
            false => part(self.near_row(i), boundary),
        }
    }

    /// Whether fluid is within the support of a boundary particle.
    pub(in crate::formulations::fluid) fn is_wet(&self, i: usize) -> bool {
        let (own, limit) = (self.records[i].position(), self.kernel.support * self.kernel.support);
        let square = |j: u32| self.offset(own, self.records[j as usize].position()).length_squared();
        self.near_row(i).iter().any(|&j| square(j) < limit)
    }

    /// Up to four neighbours of particle `i` in that body.
    #[inline(always)]
    pub(super) fn four<A: FourLanes>(&self, a: A, i: usize, group: usize, chunk: &[u32]) -> FourNear<A> {
        let rows = as_rows(filled_up(chunk));
        let FourPlaces { x, volume } =
            FourPlaces::gather(a, &self.records, &self.records[i], rows, &self.periods);
        let x_ij = Vector::new(a, x);
        let square = x_ij.length_squared().lanes();
        let (square, volume) = self.kernel.within(a, square, FILLS[chunk.len()], volume);
        let distance = a.sqrt(square);
        let pairs = NearPairs {
            group,
            is_fluid: self.groups[group].fluid().is_some(),
            x_ij,
            distance: Number::new(a, distance),
            weight: Number::new(a, self.kernel.weights(a, distance)),
            kernel: Number::new(a, self.kernel.values(a, distance)),
            volume: Number::new(a, volume),
        };
        FourNear { rows, pairs }
    }

    /// All rows of the cloud.
    pub fn everything(&self) -> Range<usize> {
        0..self.records.len()
    }

    /// Number of the first body with rows from this one on.
    pub(in crate::formulations::fluid) fn group_at(&self, row: usize) -> usize {
        self.groups.partition_point(|group| group.cloud.end <= row)
    }
}

/// Splits off the neighbours before row `end` of the cloud, where a group ends, from the rest of a row that
/// is ordered by groups.
#[inline(always)]
pub fn take_until<'a>(rest: &mut &'a [u32], end: usize) -> &'a [u32] {
    let end = end as u32;
    let count = match rest.last() {
        Some(&last) if last >= end => rest.partition_point(|&j| j < end),
        _ => rest.len(),
    };
    let (row, tail) = rest.split_at(count);
    *rest = tail;
    row
}

/// The part of a row that lies in a range of whole bodies: rows are ordered by bodies.
#[inline(always)]
pub fn part<'a>(row: &'a [u32], among: &Range<usize>) -> &'a [u32] {
    &row[part_of(row, among)]
}

/// Where that part is.
#[inline(always)]
pub(super) fn part_of(row: &[u32], among: &Range<usize>) -> Range<usize> {
    let (Some(&first), Some(&last)) = (row.first(), row.last()) else { return 0..0 };
    let (start, end) = (among.start as u32, among.end as u32);
    // Maximum number of rows have no such neighbour, and a row of one body has no other.
    if last < start || end <= first {
        return 0..0;
    }
    if start <= first && last < end {
        return 0..row.len();
    }
    row.partition_point(|&j| j < start)..row.partition_point(|&j| j < end)
}
