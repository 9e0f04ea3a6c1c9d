//! Which part of a loop a rank computes.

use std::ops::Range;

/// Longest time of a rank over the mean above which loops are divided anew.
const UNEVEN: f64 = 1.05;
/// Share that a rank without one is taken to have had.
const LEAST: f64 = 1e-3;

/// Shares of the ranks in every loop: rank r computes the part from `bounds[r]` to `bounds[r + 1]`. Results do not depend on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut(Vec<f64>);

impl Cut {
    /// Equal shares of `size` ranks.
    pub fn even(size: usize) -> Self {
        Self::by_weights(&vec![1.0; size])
    }

    /// Shares in proportion to the weights of the ranks, which are not negative; equal ones where all are zero.
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
        // The last rank with a share has all that is left, whatever rounding makes of the sum.
        let last = weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0);
        bounds[last + 1..].fill(1.0);
        Self(bounds)
    }

    /// A cut by which ranks that have worked for so long, s, on their shares are ready together; none where they nearly are, or where nothing was measured.
    pub fn balanced(&self, seconds: &[f64]) -> Option<Self> {
        let (longest, sum) = (seconds.iter().copied().fold(0.0, f64::max), seconds.iter().sum::<f64>());
        if sum <= 0.0 || longest * seconds.len() as f64 <= UNEVEN * sum {
            return None;
        }
        // Half of the way: times scatter.
        let share = |rank: usize| self.0[rank + 1] - self.0[rank];
        let speeds: Vec<f64> =
            (0..seconds.len()).map(|k| share(k).max(LEAST) / seconds[k].max(1e-9)).collect();
        let all: f64 = speeds.iter().sum();
        let weights: Vec<f64> = (0..seconds.len()).map(|k| 0.5 * (share(k) + speeds[k] / all)).collect();
        Some(Self::by_weights(&weights))
    }

    /// Blocks of rank `rank` among `count`.
    pub fn blocks(&self, rank: usize, count: usize) -> Range<usize> {
        let bound = |k: usize| ((self.0[k] * count as f64).round() as usize).min(count);
        bound(rank)..bound(rank + 1)
    }

    /// Number of ranks.
    pub fn size(&self) -> usize {
        self.0.len() - 1
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
            let seconds: Vec<f64> = (0..3).map(|k| (cut.0[k + 1] - cut.0[k]) / speeds[k]).collect();
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
    fn shares_are_in_proportion_to_the_weights() {
        let cut = Cut::by_weights(&[1.0, 3.0]);
        assert_eq!((cut.blocks(0, 100), cut.blocks(1, 100)), (0..25, 25..100));
    }
}
