//! Counting sort of particles into buckets.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

/// Number of particles up to which one thread sorts.
const FEW: usize = 8192;

/// Particles by bucket, and in the order of their rows within a bucket. Buffers are reused from one sort to
/// the next.
#[derive(Debug, Default)]
pub struct Buckets {
    keys: Vec<u32>,
    /// Particles of bucket b are `starts[b]..starts[b + 1]`; one additional entry is scratch.
    starts: Vec<u32>,
    /// Rows of the particles.
    pub rows: Vec<u32>,
}

impl Buckets {
    /// Sorts the particles at `positions` into `buckets` by `key`, which is below `buckets`.
    pub fn sort(&mut self, positions: &[DVec3], buckets: usize, key: impl Fn(DVec3) -> u32 + Sync) {
        let Self { keys, starts, rows } = self;
        let count = positions.len();
        keys.resize(count, 0);
        keys.par_iter_mut().with_min_len(4096).zip(positions).for_each(|(to, x)| *to = key(*x));
        starts.clear();
        starts.resize(buckets + 2, 0);
        rows.resize(count, 0);
        let tasks = if count < FEW { 1 } else { rayon::current_num_threads() };
        // starts[b + 1] is the write position of bucket b, and ends as the start of b + 1.
        count_keys(keys, 0, &mut starts[2..], tasks);
        for b in 2..starts.len() {
            starts[b] += starts[b - 1];
        }
        place(keys, 0, &mut starts[1..=buckets], rows, tasks);
    }

    /// Number of buckets.
    pub fn count(&self) -> usize {
        self.starts.len().saturating_sub(2)
    }

    /// Particles of a bucket, as a range of [`Buckets::rows`].
    #[inline(always)]
    pub fn range(&self, bucket: usize) -> Range<usize> {
        self.starts[bucket] as usize..self.starts[bucket + 1] as usize
    }

    /// Start of each bucket, and the end of the last.
    #[inline(always)]
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }
}

/// Counts the keys from `first` on; every task reads all of them and counts those of its range of buckets.
fn count_keys(keys: &[u32], first: u32, counts: &mut [u32], tasks: usize) {
    if tasks > 1 && counts.len() > 1 {
        let half = counts.len() / 2;
        let (low, high) = counts.split_at_mut(half);
        let rest = first + half as u32;
        rayon::join(
            || count_keys(keys, first, low, tasks.div_ceil(2)),
            || count_keys(keys, rest, high, tasks.div_ceil(2)),
        );
        return;
    }
    for key in keys {
        if let Some(count) = counts.get_mut(key.wrapping_sub(first) as usize) {
            *count += 1;
        }
    }
}

/// Writes rows to the positions of their keys, from the key `first` on; tasks have equal numbers of rows, as
/// far as the buckets allow.
fn place(keys: &[u32], first: u32, places: &mut [u32], rows: &mut [u32], tasks: usize) {
    let Some(&start) = places.first() else { return };
    if tasks > 1 && places.len() > 1 {
        let middle = start + rows.len() as u32 / 2;
        let half = places.partition_point(|&place| place < middle).clamp(1, places.len() - 1);
        let (low, high) = places.split_at_mut(half);
        let (low_rows, high_rows) = rows.split_at_mut((high[0] - start) as usize);
        let rest = first + half as u32;
        rayon::join(
            || place(keys, first, low, low_rows, tasks.div_ceil(2)),
            || place(keys, rest, high, high_rows, tasks.div_ceil(2)),
        );
        return;
    }
    for (row, key) in keys.iter().enumerate() {
        if let Some(at) = places.get_mut(key.wrapping_sub(first) as usize) {
            rows[(*at - start) as usize] = row as u32;
            *at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_stands_in_its_bucket_on_any_number_of_threads() {
        let positions: Vec<DVec3> =
            (0..30_000).map(|k| DVec3::X * (f64::from(k) * 0.7).sin().abs()).collect();
        for (buckets, last) in [(1, 0), (7, 6), (500, 300), (40_000, 39_999)] {
            let key = |x: DVec3| (x.x * f64::from(last)) as u32;
            let mut expected: Vec<u32> = (0..30_000).collect();
            expected.sort_by_key(|&row| key(positions[row as usize]));
            for threads in [1, 2, 5] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
                let mut sorted = Buckets::default();
                pool.install(|| sorted.sort(&positions, buckets, key));
                assert_eq!(sorted.rows, expected);
                assert_eq!(sorted.count(), buckets);
                for bucket in 0..buckets {
                    let rows = &sorted.rows[sorted.range(bucket)];
                    assert!(rows.iter().all(|&row| key(positions[row as usize]) as usize == bucket));
                }
            }
        }
    }
}
