//! Selects the entries of a long list that pass a test, in parallel and in order.

use crate::parallel::{BLOCK, BlockSum, Split, block_count, for_each_block, for_each_block_in_tasks};

/// Blocks of a test that a thread takes at a time: a test takes some ten nanoseconds beside a box, and
/// microseconds beside a mesh.
pub(super) const BLOCKS_OF_TEST: usize = 4;

/// Result of the test of a block.
#[derive(Clone, Copy, Default)]
pub(super) struct Found<E> {
    /// How many have passed; they come first in the slots of the block.
    pub count: usize,
    /// Additional results of the test.
    pub extra: E,
}

impl<E: BlockSum> BlockSum for Found<E> {
    fn add(&mut self, next: &Self) {
        self.count += next.count;
        self.extra.add(&next.extra);
    }
}

/// The space for a test of many, kept from one to the next.
pub(in crate::contact) struct Filter<T, E> {
    slots: Vec<T>,
    found: Vec<Found<E>>,
}

impl<T: Copy + Default + Send + Sync, E: BlockSum + Sync> Filter<T, E> {
    /// With capacity for tests of that many.
    pub fn new(count: usize) -> Self {
        Self { slots: Vec::with_capacity(count), found: Vec::with_capacity(block_count(count)) }
    }

    /// Stores the results of `test` for the numbers below `count` in `kept`, in their order; returns the sum
    /// of its additional results.
    pub fn select(
        &mut self,
        count: usize,
        kept: &mut Vec<T>,
        test: &(impl Fn(usize, &mut E) -> Option<T> + Sync),
    ) -> E {
        let Self { slots, found } = self;
        slots.resize(slots.len().max(count), T::default());
        let all =
            for_each_block_in_tasks(BLOCKS_OF_TEST, &mut slots[..count], found, &|first, slots: &mut [T]| {
                let mut found = Found { count: 0, extra: E::default() };
                for k in 0..slots.len() {
                    if let Some(passed) = test(first + k, &mut found.extra) {
                        slots[found.count] = passed;
                        found.count += 1;
                    }
                }
                found
            });
        keep(&slots[..count], found, all.count, kept);
        all.extra
    }
}

/// Moves the results in the blocks of `slots`, `count` in all, to `kept`.
pub(in crate::contact) fn keep<T: Copy + Default + Send + Sync, E: Sync>(
    slots: &[T],
    found: &[Found<E>],
    count: usize,
    kept: &mut Vec<T>,
) {
    kept.resize(count, T::default());
    let rows = KeptBlocks { slots, found, kept };
    for_each_block(rows, &mut Vec::new(), &|_, KeptBlocks { slots, kept, .. }: KeptBlocks<'_, T, E>| {
        kept.copy_from_slice(&slots[..kept.len()]);
    });
}

/// Blocks of slots, and where what was found in them goes.
struct KeptBlocks<'a, T, E> {
    slots: &'a [T],
    found: &'a [Found<E>],
    kept: &'a mut [T],
}

impl<T: Send + Sync, E: Sync> Split for KeptBlocks<'_, T, E> {
    fn rows(&self) -> usize {
        self.slots.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (found, found_rest) = self.found.split_at(at / BLOCK);
        let (slots, slots_rest) = self.slots.split_at(at);
        let (kept, kept_rest) = self.kept.split_at_mut(found.iter().map(|found| found.count).sum());
        (Self { slots, found, kept }, Self { slots: slots_rest, found: found_rest, kept: kept_rest })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_passes_keeps_its_order() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a pool");
        let (mut filter, mut kept) = (Filter::<u32, f64>::new(0), Vec::new());
        for (count, by) in [(10_000, 7), (0, 1), (63, 2), (64, 1), (3_000, 10_000)] {
            let sum = pool.install(|| {
                filter.select(count, &mut kept, &|k, sum: &mut f64| {
                    *sum += k as f64;
                    (k % by == 0).then_some(k as u32)
                })
            });
            assert!(kept.iter().copied().eq((0..count as u32).step_by(by)), "{count} {by}");
            assert_eq!(sum, (0..count).sum::<usize>() as f64);
        }
    }
}
