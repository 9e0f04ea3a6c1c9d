//! The contacts of a step: which candidates touch, and what each contact does. Both are found in parallel and kept in the order of the
//! candidates, so that nothing depends on the number of threads.

use super::memory::{Memories, Memory, PairKey};
use super::tally::Tally;
use crate::parallel::{BLOCK, BlockSum, block_count, for_each_heavy_block};

/// The candidates of a step that touch, each with what is known of it, `T`, and what it does, `P`; `E` is what else the candidates tell.
pub(super) struct Meetings<T, P, E> {
    /// As long as the list of candidates; those that touch come first.
    slots: Vec<(PairKey, T)>,
    /// Of every block of candidates.
    found: Vec<Found<E>>,
    count: usize,
    pub memories: Memories,
    pushes: Vec<P>,
    sums: Vec<Tally>,
}

#[derive(Clone, Copy, Default)]
struct Found<E> {
    count: usize,
    extra: E,
}

impl<E: BlockSum> BlockSum for Found<E> {
    fn add(&mut self, next: &Self) {
        self.count += next.count;
        self.extra.add(&next.extra);
    }
}

impl<T, P, E> Default for Meetings<T, P, E> {
    fn default() -> Self {
        let (slots, found, pushes, sums) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { slots, found, count: 0, memories: Memories::default(), pushes, sums }
    }
}

impl<T: Copy + Default + Send + Sync, P: Copy + Default + Send, E: BlockSum> Meetings<T, P, E> {
    /// Finds out which candidates touch: `test` says under which pair, ascending with the candidates. Returns what it adds up.
    pub fn find<C: Sync>(
        &mut self,
        candidates: &[C],
        test: impl Fn(&C, &mut E) -> Option<(PairKey, T)> + Sync,
    ) -> E {
        if self.slots.len() < candidates.len() {
            // Room for all that the list may bring, and the next ones: steps allocate nothing.
            let room = (2 * candidates.len()).max(BLOCK);
            self.slots.resize(room, Default::default());
            self.found.reserve(block_count(room));
            self.sums.reserve(block_count(room));
            self.pushes.reserve(room);
            self.memories.reserve(room);
        }
        let rows = (candidates, &mut self.slots[..candidates.len()]);
        let total =
            for_each_heavy_block(rows, &mut self.found, &|_, (candidates, slots): (&[C], &mut [_])| {
                let mut found = Found { count: 0, extra: E::default() };
                for candidate in candidates {
                    if let Some(met) = test(candidate, &mut found.extra) {
                        slots[found.count] = met;
                        found.count += 1;
                    }
                }
                found
            });
        self.count = 0;
        for (block, found) in self.found.iter().enumerate() {
            let first = block * BLOCK;
            self.slots.copy_within(first..first + found.count, self.count);
            self.count += found.count;
        }
        total.extra
    }

    /// The contacts of the step.
    pub fn met(&self) -> &[(PairKey, T)] {
        &self.slots[..self.count]
    }

    /// What they do.
    pub fn pushes(&self) -> impl Iterator<Item = (PairKey, &P)> {
        self.met().iter().map(|met| met.0).zip(&self.pushes)
    }

    /// Works out what every contact does, with what it remembers, and what those do that have ended. Returns what all of them hold and
    /// lose.
    pub fn respond(
        &mut self,
        each: impl Fn(PairKey, &T, &Memory, &mut Tally) -> (Memory, P) + Sync,
        end: impl Fn(PairKey, &Memory, &mut Tally),
    ) -> Tally {
        let met = &self.slots[..self.count];
        self.pushes.clear();
        self.pushes.resize(met.len(), P::default());
        let remembered = self.memories.begin(met.iter().map(|met| met.0));
        let old = remembered.old;
        let rows = (met, remembered.before, remembered.new, &mut self.pushes[..]);
        type Rows<'a, T, P> =
            (&'a [(PairKey, T)], &'a [Option<u32>], &'a mut [(PairKey, Memory)], &'a mut [P]);
        let mut tally = for_each_heavy_block(rows, &mut self.sums, &|_, rows: Rows<'_, T, P>| {
            let mut tally = Tally::default();
            let (met, before, new, pushes) = rows;
            for (((met, before), new), push) in met.iter().zip(before).zip(new).zip(pushes) {
                let before = before.map_or(Memory::default(), |k| old[k as usize].1);
                (new.1, *push) = each(met.0, &met.1, &before, &mut tally);
            }
            tally
        });
        for (key, memory) in self.memories.ended() {
            end(*key, memory, &mut tally);
        }
        self.memories.turn();
        tally
    }
}
