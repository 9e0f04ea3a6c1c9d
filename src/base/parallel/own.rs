//! Loops over the blocks of this rank, which are all blocks in a serial run.
//!
//! The results of such a loop exist for the rows of this rank alone until they are exchanged, by
//! [`share_rows`] or automatically when a column of the world is read. Sums are those over the blocks of all
//! ranks.

use std::ops::Range;

use bytemuck::Pod;

use super::blocks::{
    BLOCK, BLOCKS_PER_TASK, BlockSum, Split, block_count, blocks_of_task, divide_and_sum,
    for_each_block_in_tasks, sum_over_blocks,
};
use crate::ranks;

/// Rows of a body that this rank computes.
pub fn own_rows(body: &Range<usize>) -> Range<usize> {
    let blocks = ranks::own_blocks(block_count(body.len()));
    let row = |block: usize| body.start + (block * BLOCK).min(body.len());
    row(blocks.start)..row(blocks.end)
}

/// Rows of a body that other ranks compute.
pub fn others_rows(body: &Range<usize>) -> [Range<usize>; 2] {
    let own = own_rows(body);
    [body.start..own.start, own.end..body.end]
}

/// The rows of a part of a body that this rank computes; an empty range within the part if there are none.
pub fn own_part(body: &Range<usize>, part: &Range<usize>) -> Range<usize> {
    let own = own_rows(body);
    let within = |row: usize| row.clamp(part.start, part.end.max(part.start));
    within(own.start)..within(own.end)
}

/// Exchanges a part of the rows of a body, of `width` values each, after every rank has computed its own.
pub fn share_part<T: Pod>(values: &mut [T], width: usize, part: &Range<usize>, body: &Range<usize>) {
    let before = |row: usize| ((body.start + row).clamp(part.start, part.end) - part.start) * width;
    ranks::share_some(values, body.len(), BLOCK, before);
}

/// Exchanges the rows of a body after every rank has computed its own.
pub fn share_rows<T: Pod>(rows: &mut [T]) {
    ranks::share(rows, BLOCK);
}

/// Exchanges the rows of a body, of `width` values each, after every rank has computed its own.
pub fn share_wide_rows<T: Pod>(values: &mut [T], width: usize) {
    let rows = values.len() / width;
    let bytes = bytemuck::cast_slice_mut(values);
    ranks::share_bodies(bytes, width * size_of::<T>(), BLOCK, std::iter::once(0..rows));
}

/// Exchanges the rows of several bodies in one array.
pub fn share_rows_of<T: Pod>(rows: &mut [T], bodies: impl Iterator<Item = Range<usize>> + Clone) {
    ranks::share_bodies(bytemuck::cast_slice_mut(rows), size_of::<T>(), BLOCK, bodies);
}

/// Exchanges values of some rows of a body, in ascending order, after every rank has computed those of its
/// own rows.
pub fn share_picked<T: Pod>(values: &mut [T], rows: &[u32], body: &Range<usize>) {
    let before = |row: usize| rows.partition_point(|other| (*other as usize) < body.start + row);
    ranks::share_some(values, body.len(), BLOCK, before);
}

/// [`for_each_block`](super::for_each_block) over the blocks of this rank. The rows must be all those of a
/// body.
pub fn for_each_own_block<S: Split, R: BlockSum + Pod>(
    rows: S,
    sums: &mut Vec<R>,
    body: &(impl Fn(usize, S) -> R + Sync),
) -> R {
    for_each_own_block_in_tasks(BLOCKS_PER_TASK, rows, sums, body)
}

/// [`for_each_own_block`] with a given number of blocks per task.
pub fn for_each_own_block_in_tasks<S: Split, R: BlockSum + Pod>(
    per_task: usize,
    rows: S,
    sums: &mut Vec<R>,
    body: &(impl Fn(usize, S) -> R + Sync),
) -> R {
    match ranks::has_several() {
        true => sum_of_own(per_task, rows, body),
        false => for_each_block_in_tasks(per_task, rows, sums, body),
    }
}

/// [`sum_over_blocks`] over the blocks of all ranks; each rank runs its own.
pub fn sum_over_own_blocks<S: Split, R: BlockSum + Pod>(
    rows: S,
    body: &(impl Fn(usize, S) -> R + Sync),
) -> R {
    match ranks::has_several() {
        true => sum_of_own(BLOCKS_PER_TASK, rows, body),
        false => sum_over_blocks(rows, body),
    }
}

fn sum_of_own<S: Split, R: BlockSum + Pod>(
    per_task: usize,
    rows: S,
    body: &(impl Fn(usize, S) -> R + Sync),
) -> R {
    let (len, count) = (rows.rows(), block_count(rows.rows()));
    let own = ranks::own_blocks(count);
    let mut rest = Some(rows.split((own.start * BLOCK).min(len)).1);
    let mut sums: Vec<R> = Vec::new();
    ranks::work(|| {
        ranks::maximal_subtrees(0..count, &own, &mut |blocks| {
            let Some(rows) = rest.take() else { return };
            let (part, behind) = rows.split((blocks.end * BLOCK).min(len) - blocks.start * BLOCK);
            rest = Some(behind);
            let per_task = blocks_of_task(per_task, blocks.len());
            sums.push(divide_and_sum(per_task, blocks.start * BLOCK, blocks.len(), part, body));
        })
    });
    ranks::complete(count, &sums, &|sum: &mut R, next| sum.add(next))
}
