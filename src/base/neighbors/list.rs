//! Neighbour list in compressed row storage.

use super::{Cloud, NeighborError, NeighborSearch, Periodic};
use std::ops::Range;

/// Neighbours of every target particle, in compressed rows: row i is `indices[offsets[i]..offsets[i + 1]]`,
/// ascending, unless the search says otherwise. Data of pairs lie in arrays parallel to `indices`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NeighborList {
    pub(super) offsets: Vec<usize>,
    pub(super) indices: Vec<u32>,
}

impl Default for NeighborList {
    fn default() -> Self {
        Self { offsets: vec![0], indices: Vec::new() }
    }
}

impl NeighborList {
    /// Permanent list of a set of particles with itself, without skin and without spare memory.
    ///
    /// # Errors
    /// See [`NeighborError`].
    pub fn reference(cloud: Cloud<'_>, periodic: &Periodic) -> Result<Self, NeighborError> {
        let mut list = Self::default();
        NeighborSearch::default().within(cloud, 0.0, periodic, &mut list)?;
        list.offsets.shrink_to_fit();
        list.indices.shrink_to_fit();
        Ok(list)
    }

    /// Removes all rows.
    pub fn clear(&mut self) {
        self.offsets.truncate(1);
        self.indices.clear();
    }

    /// Adds a row behind the others.
    pub fn push_row(&mut self, row: impl IntoIterator<Item = u32>) {
        self.indices.extend(row);
        self.offsets.push(self.indices.len());
    }

    /// Removes the pairs (i, j) for which `keep` is false.
    pub fn retain(&mut self, keep: impl Fn(usize, u32) -> bool) {
        let mut kept = 0;
        for i in 0..self.rows() {
            let row = self.range(i);
            self.offsets[i] = kept;
            for k in row {
                let j = self.indices[k];
                if keep(i, j) {
                    self.indices[kept] = j;
                    kept += 1;
                }
            }
        }
        if let Some(last) = self.offsets.last_mut() {
            *last = kept;
        }
        self.indices.truncate(kept);
    }

    /// Becomes the list of sets of rows of `other`, whose first row has the number `first`. The row of a set
    /// is the union of the rows of its members, ascending; it is empty for a set that is not wanted. `last`
    /// is a buffer that the caller keeps.
    pub fn join<const N: usize>(
        &mut self,
        sets: &[[u32; N]],
        is_wanted: impl Fn(usize) -> bool,
        other: &Self,
        first: u32,
        last: &mut Vec<u32>,
    ) {
        self.offsets.clear();
        self.offsets.push(0);
        self.indices.clear();
        // The number, from one, of the last set that contains each neighbour: most neighbours are in several
        // rows of a set.
        last.clear();
        last.resize(other.indices.iter().max().map_or(0, |&most| most as usize + 1), 0);
        for (set, number) in sets.iter().zip(1_u32..) {
            let start = self.indices.len();
            let set = if is_wanted(number as usize - 1) { &set[..] } else { &[] };
            for &j in set.iter().flat_map(|&row| other.row((row - first) as usize)) {
                if last[j as usize] != number {
                    last[j as usize] = number;
                    self.indices.push(j);
                }
            }
            self.indices[start..].sort_unstable();
            self.offsets.push(self.indices.len());
        }
    }

    /// Adds the offset `by` to the neighbours, for rows of a larger set of particles.
    pub fn shift(&mut self, by: u32) {
        self.indices.iter_mut().for_each(|j| *j += by);
    }

    /// Renumbers the neighbours in the rows from `first` on.
    pub fn renumber_from(&mut self, first: usize, number: impl Fn(u32) -> u32) {
        self.indices[self.offsets[first]..].iter_mut().for_each(|j| *j = number(*j));
    }

    /// Transposes the list: row k of `other` contains the rows of this list, ascending, that contain the k-th
    /// of `rows`.
    pub fn turn(&self, rows: Range<usize>, other: &mut Self) {
        let Self { offsets, indices } = other;
        offsets.clear();
        offsets.resize(rows.len() + 2, 0);
        for &j in &self.indices {
            offsets[j as usize - rows.start + 2] += 1;
        }
        for k in 2..offsets.len() {
            offsets[k] += offsets[k - 1];
        }
        indices.resize(self.indices.len(), 0);
        // The start of each row advances to its end, the start of the next row.
        for i in 0..self.rows() {
            for &j in self.row(i) {
                let at = &mut offsets[j as usize - rows.start + 1];
                indices[*at] = i as u32;
                *at += 1;
            }
        }
        offsets.pop();
    }

    /// Number of target particles.
    pub fn rows(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of directed pairs.
    pub fn pairs(&self) -> usize {
        self.indices.len()
    }

    /// Neighbours of particle `i`.
    #[inline]
    pub fn row(&self, i: usize) -> &[u32] {
        &self.indices[self.range(i)]
    }

    /// Range of row `i` in [`NeighborList::indices`] and in arrays of pair data.
    #[inline]
    pub fn range(&self, i: usize) -> Range<usize> {
        self.offsets[i]..self.offsets[i + 1]
    }

    /// Row starts, and the end of the last row.
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// The concatenated rows.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Number of neighbours of each particle.
    pub fn counts(&self) -> impl Iterator<Item = usize> {
        self.offsets.windows(2).map(|w| w[1] - w[0])
    }

    /// Mean number of neighbours; zero without particles.
    pub fn mean_count(&self) -> f64 {
        self.pairs() as f64 / self.rows().max(1) as f64
    }

    /// Minimum number of neighbours; zero without particles.
    pub fn min_count(&self) -> usize {
        self.counts().min().unwrap_or(0)
    }

    /// Maximum number of neighbours; zero without particles.
    pub fn max_count(&self) -> usize {
        self.counts().max().unwrap_or(0)
    }

    /// Allocated memory (B).
    pub fn memory_bytes(&self) -> usize {
        self.offsets.capacity() * size_of::<usize>() + self.indices.capacity() * size_of::<u32>()
    }
}
