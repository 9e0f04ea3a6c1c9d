//! Sums over the blocks of all ranks, along the same tree as in a serial run.
//!
//! The tree halves the number of blocks. A rank computes the sums of the largest subtrees within its range,
//! at most two of each size. These are exchanged, and every rank completes the tree.

use std::ops::Range;

use bytemuck::Pod;

use super::group;

/// Calls `f` with the blocks of each of the largest subtrees of a tree over the blocks `node` that lie in the
/// range `own`, ascending.
pub(crate) fn maximal_subtrees(node: Range<usize>, own: &Range<usize>, f: &mut impl FnMut(Range<usize>)) {
    if own.is_empty() || node.end <= own.start || node.start >= own.end {
        return;
    }
    if own.start <= node.start && node.end <= own.end {
        return f(node);
    }
    let middle = node.start + node.len() / 2;
    maximal_subtrees(node.start..middle, own, f);
    maximal_subtrees(middle..node.end, own, f);
}

/// The sum over `count` blocks; `own` are the sums of the largest subtrees of this rank.
pub(crate) fn complete<R: Pod + Default>(count: usize, own: &[R], add: &impl Fn(&mut R, &R)) -> R {
    if count == 0 || size_of::<R>() == 0 {
        return R::default();
    }
    let sum = group::with(|group| {
        let size = group.ranks.size();
        let ranges: Vec<Range<usize>> = (0..size).map(|rank| group.cut.blocks(rank, count)).collect();
        let mut cuts = vec![0];
        for range in &ranges {
            let mut subtrees = 0;
            maximal_subtrees(0..count, range, &mut |_| subtrees += 1);
            cuts.push(cuts[cuts.len() - 1] + subtrees * size_of::<R>());
        }
        let mut sums = vec![R::zeroed(); cuts[size] / size_of::<R>()];
        let first = cuts[group.ranks.rank()] / size_of::<R>();
        sums[first..first + own.len()].copy_from_slice(own);
        group.share(bytemuck::cast_slice_mut(&mut sums), &cuts);
        let mut next: Vec<usize> = cuts.iter().map(|cut| cut / size_of::<R>()).collect();
        sum_of(0..count, &ranges, &sums, &mut next, add)
    });
    sum.unwrap_or_default()
}

/// The sum of a node of the tree; `next` is the index of the next sum of each rank.
fn sum_of<R: Pod>(
    node: Range<usize>,
    ranges: &[Range<usize>],
    sums: &[R],
    next: &mut [usize],
    add: &impl Fn(&mut R, &R),
) -> R {
    let holds = |range: &Range<usize>| range.start <= node.start && node.end <= range.end;
    if let Some(rank) = ranges.iter().position(holds) {
        next[rank] += 1;
        return sums[next[rank] - 1];
    }
    let middle = node.start + node.len() / 2;
    let mut sum = sum_of(node.start..middle, ranges, sums, next, add);
    add(&mut sum, &sum_of(middle..node.end, ranges, sums, next, add));
    sum
}
