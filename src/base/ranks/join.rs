//! Element-wise reduction of arrays over ranks, and concatenation.

use bytemuck::Pod;

use super::collective::{ReceivedParts, SentParts};
use super::group;

/// Reduces the values of all ranks element by element: every rank reduces a part of the elements, and the
/// results are gathered. `join` must be bitwise independent of the order, as a minimum or a maximum is.
pub fn join<T: Pod>(values: &mut [T], join: impl Fn(T, T) -> T) {
    group::with(|group| {
        let (rank, size, count) = (group.ranks.rank(), group.ranks.size(), values.len());
        let cuts: Vec<usize> = (0..=size).map(|k| k * count / size).collect();
        let in_bytes = |cuts: &[usize]| cuts.iter().map(|cut| cut * size_of::<T>()).collect::<Vec<_>>();
        let own = cuts[rank]..cuts[rank + 1];
        let of_all: Vec<usize> = (0..=size).map(|k| k * own.len()).collect();
        let mut received = vec![T::zeroed(); own.len() * size];
        group.exchange(
            SentParts { bytes: bytemuck::cast_slice(values), cuts: &in_bytes(&cuts) },
            ReceivedParts { bytes: bytemuck::cast_slice_mut(&mut received), cuts: &in_bytes(&of_all) },
        );
        for (k, value) in values[own.clone()].iter_mut().enumerate() {
            let of_rank = |rank: usize| received[rank * own.len() + k];
            *value = (1..size).fold(of_rank(0), |joined, rank| join(joined, of_rank(rank)));
        }
        group.share(bytemuck::cast_slice_mut(values), &in_bytes(&cuts));
    });
}

/// Concatenates the values of all ranks, in the order of ranks.
pub fn concatenate<T: Pod>(values: &mut Vec<T>) {
    let counts = group::gather(values.len() as u64);
    if counts.iter().all(|&count| count == 0) {
        return;
    }
    group::with(|group| {
        let mut cuts = vec![0];
        for count in &counts {
            cuts.push(cuts[cuts.len() - 1] + *count as usize * size_of::<T>());
        }
        let mut all = vec![T::zeroed(); cuts[counts.len()] / size_of::<T>()];
        let first = cuts[group.ranks.rank()] / size_of::<T>();
        all[first..first + values.len()].copy_from_slice(values);
        group.share(bytemuck::cast_slice_mut(&mut all), &cuts);
        *values = all;
    });
}

/// [`concatenate`] for rows that are exchanged as `WORDS` words each, sorted by `key`; it does nothing in a
/// serial run.
pub fn concatenate_rows<R, const WORDS: usize>(
    rows: &mut Vec<R>,
    to_words: impl Fn(&R) -> [u64; WORDS],
    of_words: impl Fn(&[u64; WORDS]) -> R,
    key: impl Fn(&R) -> usize,
) where
    [u64; WORDS]: Pod,
{
    if group::has_several() {
        let mut words: Vec<[u64; WORDS]> = rows.iter().map(to_words).collect();
        concatenate(&mut words);
        rows.clear();
        rows.extend(words.iter().map(of_words));
        rows.sort_unstable_by_key(key);
    }
}
