//! The neighbours within the support, selected from the lists in every step.
//!
//! A third of the pairs of a list is in its skin only. The first pass over a list computes the distances and
//! records the neighbours within the support; later passes leave out the rest.

use std::ops::Range;

use crate::neighbors::NeighborList;
use crate::parallel::{FourLanes, Split};

/// Rows of neighbours, each in the slots that its rows in the lists ask for.
#[derive(Debug, Default)]
pub struct NearRows {
    /// Where the slots of each row start, and the end of the last.
    starts: Vec<usize>,
    counts: Vec<u32>,
    indices: Vec<u32>,
    /// For each neighbour of a block whose particles it is near, a bit each; empty where nobody asks.
    lanes: Vec<u8>,
}

impl NearRows {
    /// Allocates memory for the rows of these lists together.
    pub fn allocate(&mut self, lists: &[&NeighborList]) {
        let rows = lists[0].rows();
        self.starts.clear();
        // Four are written at once.
        self.starts
            .extend((0..=rows).map(|i| 4 * i + lists.iter().map(|list| list.offsets()[i]).sum::<usize>()));
        self.counts.resize(rows, 0);
        self.indices.resize(self.starts[rows], 0);
    }

    /// Allocates memory for that many neighbours of each of some rows.
    pub fn allocate_rows(&mut self, rows: usize, most: impl Fn(usize) -> usize) {
        self.starts.clear();
        self.starts.push(0);
        let mut end = 0;
        self.starts.extend((0..rows).map(|i| {
            end += most(i) + 4;
            end
        }));
        self.counts.resize(rows, 0);
        self.indices.resize(end, 0);
    }

    /// Keeps bits for each neighbour, once there is memory for these.
    pub fn keep_lanes(&mut self) {
        self.lanes.resize(self.indices.len(), 0);
    }

    /// The bits of the neighbours of row `i`.
    #[inline(always)]
    pub fn lanes(&self, i: usize) -> &[u8] {
        let start = self.starts[i];
        &self.lanes[start..start + self.counts[i] as usize]
    }

    /// Neighbours of row `i` within the support.
    #[inline(always)]
    pub fn row(&self, i: usize) -> &[u32] {
        let start = self.starts[i];
        &self.indices[start..start + self.counts[i] as usize]
    }

    /// Fills rows that other ranks read with all pairs of their lists, and the bits of each: reads of
    /// neighbours within the support leave out those beyond.
    pub fn fill_others<'l>(
        &mut self,
        others: impl Iterator<Item = Range<usize>>,
        lists: impl Fn(usize) -> [(&'l [u32], &'l [u8]); 2],
    ) {
        for rows in others {
            for row in rows {
                let (start, mut used) = (self.starts[row], 0);
                for (list, bits) in lists(row) {
                    let place = start + used..start + used + list.len();
                    self.indices[place.clone()].copy_from_slice(list);
                    if !bits.is_empty() {
                        self.lanes[place].copy_from_slice(bits);
                    }
                    used += list.len();
                }
                self.counts[row] = used as u32;
            }
        }
    }

    /// All rows, to be written.
    pub fn writer(&mut self) -> NearWriter<'_> {
        let Self { starts, counts, indices, lanes } = self;
        NearWriter { starts, counts, indices, lanes }
    }
}

/// Some rows that are written.
pub struct NearWriter<'a> {
    starts: &'a [usize],
    counts: &'a mut [u32],
    indices: &'a mut [u32],
    lanes: &'a mut [u8],
}

impl Split for NearWriter<'_> {
    fn rows(&self) -> usize {
        self.counts.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (counts, counts_rest) = self.counts.split_at_mut(at);
        let cut = self.starts[at] - self.starts[0];
        let (indices, indices_rest) = self.indices.split_at_mut(cut);
        let (lanes, lanes_rest) = self.lanes.split_at_mut(cut.min(self.lanes.len()));
        (
            Self { starts: &self.starts[..=at], counts, indices, lanes },
            Self {
                starts: &self.starts[at..],
                counts: counts_rest,
                indices: indices_rest,
                lanes: lanes_rest,
            },
        )
    }
}

impl NearWriter<'_> {
    /// Number of rows.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.counts.len()
    }

    /// Row `k` of these, empty.
    #[inline(always)]
    pub fn row(&mut self, k: usize) -> NearRow<'_> {
        let first = self.starts[0];
        let part = self.starts[k] - first..self.starts[k + 1] - first;
        let lanes = if self.lanes.is_empty() { &mut [][..] } else { &mut self.lanes[part.clone()] };
        NearRow { slots: &mut self.indices[part], lanes, used: 0, count: &mut self.counts[k] }
    }
}

/// A row that is written.
pub struct NearRow<'a> {
    slots: &'a mut [u32],
    lanes: &'a mut [u8],
    used: usize,
    count: &'a mut u32,
}

impl<'a> NearRow<'a> {
    /// Appends those of four rows whose bits are set.
    #[inline(always)]
    pub fn push<A: FourLanes>(&mut self, a: A, four: [u32; 4], bits: usize) {
        if let Some(out) = self.slots[self.used..].first_chunk_mut() {
            *out = a.pack(four, bits);
        }
        self.used += bits.count_ones() as usize;
    }

    /// Appends a row that is near the particles of a block whose bits are set, if there is one; without a
    /// branch.
    #[inline(always)]
    pub fn push_if<const LANES: bool>(&mut self, j: u32, bits: usize) {
        if let Some(out) = self.slots.get_mut(self.used) {
            *out = j;
        }
        if LANES && let Some(out) = self.lanes.get_mut(self.used) {
            *out = bits as u8;
        }
        self.used += usize::from(bits != 0);
    }

    /// Ends the row, and gives it.
    #[inline(always)]
    pub fn close(self) -> &'a [u32] {
        *self.count = self.used as u32;
        &self.slots[..self.used]
    }
}
