//! Loops over blocks of rows. The rows of a block are the same on any thread, and sums are taken in block
//! order, so that every result is independent of the number of threads.

use glam::DVec3;

/// Rows per block. The columns of a block stay in the first-level cache between the steps of a fused pass.
pub const BLOCK: usize = 64;

/// Number of blocks of `len` rows.
pub fn block_count(len: usize) -> usize {
    len.div_ceil(BLOCK)
}

/// A set of slices over the same rows that can be split in two, one half for each thread.
pub trait Split: Sized + Send {
    /// Number of rows.
    fn rows(&self) -> usize;
    /// The rows before `at` and the rows from `at` on.
    fn split(self, at: usize) -> (Self, Self);
}

impl<T: Sync> Split for &[T] {
    fn rows(&self) -> usize {
        self.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl<T: Send> Split for &mut [T] {
    fn rows(&self) -> usize {
        self.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

macro_rules! split_tuple {
    ($($name:ident $k:tt),+) => {
        impl<$($name: Split),+> Split for ($($name,)+) {
            fn rows(&self) -> usize {
                self.0.rows()
            }

            fn split(self, at: usize) -> (Self, Self) {
                let parts = ($(self.$k.split(at),)+);
                (($(parts.$k.0,)+), ($(parts.$k.1,)+))
            }
        }
    };
}
split_tuple!(A 0);
split_tuple!(A 0, B 1);
split_tuple!(A 0, B 1, C 2);
split_tuple!(A 0, B 1, C 2, D 3);
split_tuple!(A 0, B 1, C 2, D 3, E 4);
split_tuple!(A 0, B 1, C 2, D 3, E 4, F 5);
split_tuple!(A 0, B 1, C 2, D 3, E 4, F 5, G 6);
split_tuple!(A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7);

impl<S: Split> Split for Option<S> {
    fn rows(&self) -> usize {
        self.as_ref().map_or(0, Split::rows)
    }

    fn split(self, at: usize) -> (Self, Self) {
        self.map(|rows| rows.split(at)).unzip()
    }
}

/// Implements [`Split`] for a struct of slices over the same rows: `split_by_rows!(Rows { a, b } and { c })`
/// splits the fields a and b, each of which may also be empty, and copies c to both halves.
#[macro_export]
macro_rules! split_by_rows {
    ($name:ident { $($field:ident),+ } $(and { $($same:ident),+ })?) => {
        impl $crate::parallel::Split for $name<'_> {
            fn rows(&self) -> usize {
                let rows = [$($crate::parallel::Split::rows(&self.$field)),+];
                rows.into_iter().max().unwrap_or_default()
            }

            fn split(self, at: usize) -> (Self, Self) {
                $(
                    let rows = $crate::parallel::Split::rows(&self.$field);
                    debug_assert!(rows == 0 || at <= rows, "a field has other rows");
                    let $field = $crate::parallel::Split::split(self.$field, at.min(rows));
                )+
                (
                    Self { $($field: $field.0,)+ $($($same: self.$same,)+)? },
                    Self { $($field: $field.1,)+ $($($same: self.$same,)+)? },
                )
            }
        }
    };
}
/// Contribution of a block to a reduction over all rows.
pub trait BlockSum: Copy + Default + Send {
    /// Adds the contribution of the next block.
    fn add(&mut self, next: &Self);
}

/// Runs `body(first_row, rows)` on every block of [`BLOCK`] rows, in parallel, and returns the sum of the
/// results of the blocks, taken pairwise along a tree that depends on the number of rows alone. `sums` is
/// scratch memory, kept by the caller so that a step does not allocate.
pub fn for_each_block<S: Split, R: BlockSum>(
    rows: S,
    sums: &mut Vec<R>,
    body: &(impl Fn(usize, S) -> R + Sync),
) -> R {
    for_each_block_in_tasks(BLOCKS_PER_TASK, rows, sums, body)
}

/// [`for_each_block`] with one task per block, for loops that take microseconds per row.
pub fn for_each_heavy_block<S: Split, R: BlockSum>(
    rows: S,
    sums: &mut Vec<R>,
    body: &(impl Fn(usize, S) -> R + Sync),
) -> R {
    for_each_block_in_tasks(1, rows, sums, body)
}

/// [`for_each_block`] with a given number of blocks per task. A task of about twenty microseconds is worth
/// scheduling on another thread.
pub fn for_each_block_in_tasks<S: Split, R: BlockSum>(
    per_task: usize,
    rows: S,
    sums: &mut Vec<R>,
    body: &(impl Fn(usize, S) -> R + Sync),
) -> R {
    let count = block_count(rows.rows());
    sums.clear();
    sums.resize(count, R::default());
    if count > 0 {
        divide(blocks_of_task(per_task, count), 0, rows, sums, body);
    }
    total(sums)
}

/// The sum of the results of blocks, pairwise along the tree of [`sum_over_blocks`].
fn total<R: BlockSum>(sums: &[R]) -> R {
    match sums {
        [] => R::default(),
        [one] => *one,
        _ => {
            let (left, right) = sums.split_at(sums.len() / 2);
            let mut sum = total(left);
            sum.add(&total(right));
            sum
        }
    }
}

/// Runs `body(first_row, rows)` on every block of [`BLOCK`] rows, in parallel, and returns the sum of the
/// results of the blocks. It is [`for_each_block`] for loops without scratch memory. The sum is taken
/// pairwise along a tree that depends on the number of rows alone.
pub fn sum_over_blocks<S: Split, R: BlockSum>(rows: S, body: &(impl Fn(usize, S) -> R + Sync)) -> R {
    match block_count(rows.rows()) {
        0 => R::default(),
        count => divide_and_sum(blocks_of_task(BLOCKS_PER_TASK, count), 0, count, rows, body),
    }
}

/// Blocks that a task runs in sequence. With one thread these are all blocks, which the calling thread runs
/// itself without waking another.
pub(super) fn blocks_of_task(usual: usize, count: usize) -> usize {
    if rayon::current_num_threads() == 1 { count } else { usual }
}

pub(super) fn divide_and_sum<S: Split, R: BlockSum>(
    per_task: usize,
    first_row: usize,
    count: usize,
    rows: S,
    body: &(impl Fn(usize, S) -> R + Sync),
) -> R {
    if count == 1 {
        return body(first_row, rows);
    }
    let half = count / 2;
    let (left, right) = rows.split(half * BLOCK);
    let (mut left, mut right) = (Some(left), Some(right));
    let (mut sum, mut next) = (R::default(), R::default());
    let mut left = || {
        if let Some(rows) = left.take() {
            sum = divide_and_sum(per_task, first_row, half, rows, body);
        }
    };
    let mut right = || {
        if let Some(rows) = right.take() {
            next = divide_and_sum(per_task, first_row + half * BLOCK, count - half, rows, body);
        }
    };
    if count > per_task {
        join(&mut left, &mut right);
    } else {
        left();
        right();
    }
    sum.add(&next);
    sum
}

/// Runs `left` and `right`, in parallel if there are two threads. rayon's join is instantiated for every loop
/// that calls it, a tenth of the program; this one is compiled once.
fn join(left: &mut (dyn FnMut() + Send), right: &mut (dyn FnMut() + Send)) {
    rayon::join(left, right);
}

/// Blocks that one task runs in sequence: few enough for load balance, enough to hide the scheduling cost.
pub(super) const BLOCKS_PER_TASK: usize = 16;

fn divide<S: Split, R: BlockSum>(
    per_task: usize,
    first_row: usize,
    rows: S,
    sums: &mut [R],
    body: &(impl Fn(usize, S) -> R + Sync),
) {
    if sums.len() > per_task {
        let half = sums.len() / 2;
        let (left, right) = rows.split(half * BLOCK);
        let (mut left, mut right) = (Some(left), Some(right));
        let (left_sums, right_sums) = sums.split_at_mut(half);
        join(
            &mut || {
                if let Some(rows) = left.take() {
                    divide(per_task, first_row, rows, left_sums, body);
                }
            },
            &mut || {
                if let Some(rows) = right.take() {
                    divide(per_task, first_row + half * BLOCK, rows, right_sums, body);
                }
            },
        );
        return;
    }
    let mut rest = rows;
    let mut first = first_row;
    let last = sums.len() - 1;
    for sum in &mut sums[..last] {
        let (block, tail) = rest.split(BLOCK);
        *sum = body(first, block);
        rest = tail;
        first += BLOCK;
    }
    sums[last] = body(first, rest);
}

impl BlockSum for () {
    fn add(&mut self, (): &Self) {}
}

impl BlockSum for f64 {
    fn add(&mut self, next: &Self) {
        *self += next;
    }
}

impl BlockSum for DVec3 {
    fn add(&mut self, next: &Self) {
        *self += *next;
    }
}

impl<A: BlockSum, B: BlockSum> BlockSum for (A, B) {
    fn add(&mut self, next: &Self) {
        self.0.add(&next.0);
        self.1.add(&next.1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum_of(values: &[f64], threads: usize) -> f64 {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let mut sums = Vec::new();
        pool.install(|| {
            let light = for_each_block(values, &mut sums, &|_, rows: &[f64]| rows.iter().sum::<f64>());
            let heavy = for_each_heavy_block(values, &mut sums, &|_, rows: &[f64]| rows.iter().sum::<f64>());
            assert_eq!(light.to_bits(), heavy.to_bits());
            light
        })
    }

    #[test]
    fn sums_are_the_same_on_any_number_of_threads() {
        let values: Vec<f64> = (0..10_007).map(|k| (f64::from(k) * 0.7).sin() * 1e3).collect();
        // A second implementation of the tree.
        fn along_tree(sums: &[f64]) -> f64 {
            let half = sums.len() / 2;
            if half == 0 { sums[0] } else { along_tree(&sums[..half]) + along_tree(&sums[half..]) }
        }
        let blocks: Vec<f64> = values.chunks(BLOCK).map(|c| c.iter().sum::<f64>()).collect();
        let expected = along_tree(&blocks).to_bits();
        for threads in [1, 2, 7] {
            assert_eq!(sum_of(&values, threads).to_bits(), expected);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let unkept =
                pool.install(|| sum_over_blocks(&values[..], &|_, rows: &[f64]| rows.iter().sum::<f64>()));
            assert_eq!(unkept.to_bits(), expected);
        }
    }

    #[test]
    fn every_row_is_visited_once_with_its_own_index() {
        for len in [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 40 * BLOCK + 3] {
            let mut rows = vec![0_usize; len];
            for_each_block(&mut rows[..], &mut Vec::new(), &|first, block: &mut [usize]| {
                for (k, row) in block.iter_mut().enumerate() {
                    *row += first + k + 1;
                }
            });
            assert!(rows.iter().enumerate().all(|(k, &row)| row == k + 1));
            let count = sum_over_blocks(&rows[..], &|first, block: &[usize]| {
                assert!(block.iter().enumerate().all(|(k, &row)| row == first + k + 1));
                block.len() as f64
            });
            assert_eq!(count, len as f64);
        }
    }
}
