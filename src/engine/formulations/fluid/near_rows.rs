//! The neighbours within the support, taken out of the lists in every step.
//!
//! A third of the pairs of a list is in its skin only. The first pass over a list has the distances in its hands: it writes down who is near,
//! and the passes after it leave out the rest.

use crate::neighbors::NeighborList;
use crate::parallel::{Arithmetic, Split};

/// Rows of neighbours, each in the room that its rows in the lists ask for.
#[derive(Debug, Default)]
pub(super) struct NearRows {
    /// Where the room of each row starts, and the end of the last.
    starts: Vec<usize>,
    counts: Vec<u32>,
    indices: Vec<u32>,
}

impl NearRows {
    /// Makes room for the rows of these lists together.
    pub fn make_room(&mut self, lists: &[&NeighborList]) {
        let rows = lists[0].rows();
        self.starts.clear();
        // Four are written at once.
        self.starts
            .extend((0..=rows).map(|i| 4 * i + lists.iter().map(|list| list.offsets()[i]).sum::<usize>()));
        self.counts.resize(rows, 0);
        self.indices.resize(self.starts[rows], 0);
    }

    /// Neighbours of row `i` within the support.
    #[inline(always)]
    pub fn row(&self, i: usize) -> &[u32] {
        let start = self.starts[i];
        &self.indices[start..start + self.counts[i] as usize]
    }

    /// All rows, to be written.
    pub fn writer(&mut self) -> NearWriter<'_> {
        NearWriter { starts: &self.starts, counts: &mut self.counts, indices: &mut self.indices }
    }
}

/// Some rows that are written.
pub(super) struct NearWriter<'a> {
    starts: &'a [usize],
    counts: &'a mut [u32],
    indices: &'a mut [u32],
}

impl Split for NearWriter<'_> {
    fn rows(&self) -> usize {
        self.counts.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (counts, counts_rest) = self.counts.split_at_mut(at);
        let (indices, indices_rest) = self.indices.split_at_mut(self.starts[at] - self.starts[0]);
        (
            Self { starts: &self.starts[..=at], counts, indices },
            Self { starts: &self.starts[at..], counts: counts_rest, indices: indices_rest },
        )
    }
}

impl NearWriter<'_> {
    /// Row `k` of these, empty.
    #[inline(always)]
    pub fn row(&mut self, k: usize) -> NearRow<'_> {
        let first = self.starts[0];
        let room = &mut self.indices[self.starts[k] - first..self.starts[k + 1] - first];
        NearRow { room, used: 0, count: &mut self.counts[k] }
    }
}

/// A row that is written.
pub(super) struct NearRow<'a> {
    room: &'a mut [u32],
    used: usize,
    count: &'a mut u32,
}

impl NearRow<'_> {
    /// Appends those of four rows whose bits are set.
    #[inline(always)]
    pub fn push<A: Arithmetic>(&mut self, a: A, four: [u32; 4], bits: usize) {
        if let Some(out) = self.room[self.used..].first_chunk_mut() {
            *out = a.pack(four, bits);
        }
        self.used += bits.count_ones() as usize;
    }

    /// Ends the row.
    #[inline(always)]
    pub fn close(self) {
        *self.count = self.used as u32;
    }
}
