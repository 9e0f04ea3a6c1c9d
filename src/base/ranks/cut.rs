//! The partition of loops over ranks.

use std::ops::Range;

/// Ratio of the longest time of a rank to the mean, above which loops are repartitioned.
const UNEVEN: f64 = 1.05;
/// Share assumed for a rank whose share is zero.
const MIN_SHARE: f64 = 1e-3;

/// Ratio of the load of a rank to its share, above which blocks of unequal cost are partitioned by their
/// weights.
const UNEVEN_WEIGHTS: f64 = 1.1;

/// Partition of every loop over the ranks: rank r computes the part from `bounds[r]` to `bounds[r + 1]`.
/// Results do not depend on the partition.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    bounds: Vec<f64>,
    /// End of the part of each rank in loops over a given number of blocks of unequal cost.
    weighed: Vec<(usize, Vec<usize>)>,
}

impl Cut {
    /// Equal shares for `size` ranks.
    pub fn even(size: usize) -> Self {
        Self::by_weights(&vec![1.0; size])
    }

    /// Shares in proportion to the weights of the ranks, which are not negative; equal ones where all are
    /// zero.
    pub fn by_weights(weights: &[f64]) -> Self {
        let sum: f64 = weights.iter().sum();
        if sum <= 0.0 {
            return Self::even(weights.len());
        }
        let mut bounds = vec![0.0];
        let mut before = 0.0;
        for weight in weights {
            before += weight / sum;
            bounds.push(before.min(1.0));
        }
        // The last rank with a share takes the remainder, so that rounding of the sum loses nothing.
        let last = weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0);
        bounds[last + 1..].fill(1.0);
        Self { bounds, weighed: Vec::new() }
    }

    /// A partition that balances the load, from the time, s, that each rank has spent on its share; `None`
    /// where the load is nearly balanced or no time was measured.
    pub fn balanced(&self, seconds: &[f64]) -> Option<Self> {
        let (longest, sum) = (seconds.iter().copied().fold(0.0, f64::max), seconds.iter().sum::<f64>());
        if sum <= 0.0 || longest * seconds.len() as f64 <= UNEVEN * sum {
            return None;
        }
        // Half of the correction is applied, because times scatter.
        let share = |rank: usize| self.bounds[rank + 1] - self.bounds[rank];
        let speeds: Vec<f64> =
            (0..seconds.len()).map(|k| share(k).max(MIN_SHARE) / seconds[k].max(1e-9)).collect();
        let all: f64 = speeds.iter().sum();
        let weights: Vec<f64> = (0..seconds.len()).map(|k| 0.5 * (share(k) + speeds[k] / all)).collect();
        Some(Self::by_weights(&weights))
    }

    /// Blocks of rank `rank` in a loop over `count` blocks.
    pub fn blocks(&self, rank: usize, count: usize) -> Range<usize> {
        if let Some((_, ends)) = self.weighed.iter().find(|(weighed, _)| *weighed == count) {
            return rank.checked_sub(1).map_or(0, |before| ends[before])..ends[rank];
        }
        let bound = |k: usize| ((self.bounds[k] * count as f64).round() as usize).min(count);
        bound(rank)..bound(rank + 1)
    }

    /// The partition by the weights of blocks, for loops over as many blocks; `None` where the weights are
    /// balanced already or are all zero.
    pub fn weighed(&self, weights: &[f64]) -> Option<Self> {
        let (count, sum) = (weights.len(), weights.iter().sum::<f64>());
        let share = |rank: usize| self.bounds[rank + 1] - self.bounds[rank];
        let load = |rank: usize| weights[self.blocks(rank, count)].iter().sum::<f64>();
        let is_uneven = |rank: usize| load(rank) > UNEVEN_WEIGHTS * share(rank).max(1.0 / count as f64) * sum;
        if sum <= 0.0 || !(0..self.size()).any(is_uneven) {
            return None;
        }
        let (mut end, mut before) = (0, 0.0);
        let ends = self.bounds[1..].iter().map(|bound| {
            // A block goes to the rank with the largest part of it.
            while end < count && before + 0.5 * weights[end] < bound * sum {
                before += weights[end];
                end += 1;
            }
            end
        });
        let mut ends: Vec<usize> = ends.collect();
        // The last rank with a share takes the remainder, so that rounding of the sum loses nothing.
        let last = (0..self.size()).rposition(|rank| share(rank) > 0.0).unwrap_or(0);
        ends[last..].fill(count);
        let mut cut = self.clone();
        cut.weighed.retain(|(weighed, _)| *weighed != count);
        cut.weighed.push((count, ends));
        (cut != *self).then_some(cut)
    }

    /// Number of ranks.
    pub fn size(&self) -> usize {
        self.bounds.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_block_has_one_rank() {
        for weights in [vec![1.0; 4], vec![0.3, 0.0, 2.0], vec![0.0, 0.0], vec![0.0, 1.0, 0.0]] {
            let cut = Cut::by_weights(&weights);
            for count in [0, 1, 2, 7, 4_097] {
                let parts = (0..weights.len()).map(|rank| cut.blocks(rank, count));
                let end = parts.fold(0, |end, part| {
                    assert_eq!(part.start, end);
                    part.end
                });
                assert_eq!(end, count, "{weights:?}");
            }
        }
    }

    #[test]
    fn slow_ranks_get_less_until_all_are_ready_together() {
        let speeds = [1.0, 2.0, 1.0];
        let mut cut = Cut::even(3);
        for _ in 0..20 {
            let seconds: Vec<f64> = (0..3).map(|k| (cut.bounds[k + 1] - cut.bounds[k]) / speeds[k]).collect();
            cut = cut.balanced(&seconds).unwrap_or(cut);
        }
        let blocks: Vec<usize> = (0..3).map(|rank| cut.blocks(rank, 1000).len()).collect();
        assert!(
            blocks.iter().zip([250, 500, 250]).all(|(found, right)| found.abs_diff(right) < 25),
            "{blocks:?}"
        );
        assert_eq!(Cut::even(2).balanced(&[1.0, 1.02]), None);
        assert_eq!(Cut::even(2).balanced(&[0.0, 0.0]), None);
    }

    #[test]
    fn blocks_that_differ_are_divided_by_their_weights() {
        // All work is in the second quarter.
        let weights: Vec<f64> = (0..100).map(|k| if (25..50).contains(&k) { 1.0 } else { 0.0 }).collect();
        for shares in [vec![1.0, 1.0], vec![1.0, 3.0], vec![2.0, 0.0, 1.0, 2.0], vec![1.0, 1.0, 0.0]] {
            let even = Cut::by_weights(&shares);
            let cut = even.weighed(&weights).expect("another cut");
            let mut end = 0;
            for (rank, share) in shares.iter().enumerate() {
                let part = cut.blocks(rank, weights.len());
                assert_eq!(part.start, end);
                end = part.end;
                let load: f64 = weights[part].iter().sum();
                assert!((load - 25.0 * share / shares.iter().sum::<f64>()).abs() <= 0.5, "{shares:?} {rank}");
            }
            assert_eq!(end, weights.len());
            assert_eq!(cut.blocks(1, 99), even.blocks(1, 99));
            assert_eq!(cut.weighed(&weights), None);
        }
        assert_eq!(Cut::even(2).weighed(&[1.0; 64]), None);
        assert_eq!(Cut::even(2).weighed(&[0.0; 64]), None);
        assert_eq!(Cut::even(2).weighed(&[]), None);
    }

    #[test]
    fn shares_are_in_proportion_to_the_weights() {
        let cut = Cut::by_weights(&[1.0, 3.0]);
        assert_eq!((cut.blocks(0, 100), cut.blocks(1, 100)), (0..25, 25..100));
    }
}
