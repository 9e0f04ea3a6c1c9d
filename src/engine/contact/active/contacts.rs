//! The active contacts of a step and their forces. Both are computed in parallel and kept in the order of the
//! candidates. Energies are added by the nodes of the first body, in blocks of its rows, so that nothing
//! depends on the number of threads or on the age of the list of candidates.

use super::filter::{BLOCKS_OF_TEST, Found, keep};
use crate::contact::response::{ContactEnergy, Histories, History, PairKey};
use crate::parallel::{BLOCK, BlockSum, block_count, for_each_block_in_tasks, for_each_heavy_block};
use crate::world::sum_by_row;

/// In the place of a number for candidates that do not touch.
const NONE: u32 = u32::MAX;

/// The active contacts among the candidates of a step, each with its geometry, `T`, and its force, `P`; `E`
/// are additional results for the candidates.
pub(in crate::contact) struct ActiveContacts<T, P, E> {
    /// As long as the list of candidates; in each block those that touch come first.
    slots: Vec<(PairKey, T)>,
    found: Vec<Found<E>>,
    met: Vec<(PairKey, T)>,
    numbers: Numbers,
    pub histories: Histories,
    pushes: Vec<P>,
    energies: Vec<ContactEnergy>,
}

/// Which contact belongs to a candidate.
#[derive(Default)]
pub(in crate::contact) struct Numbers {
    /// Of every candidate its number among those of its block that touch.
    within: Vec<u32>,
    /// Of every block the number of its first contact.
    first: Vec<u32>,
}

impl Numbers {
    /// Number of the contact of a candidate, if it touches.
    #[inline]
    pub fn of(&self, candidate: u32) -> Option<usize> {
        let candidate = candidate as usize;
        let within = self.within[candidate];
        (within != NONE).then(|| (self.first[candidate / BLOCK] + within) as usize)
    }
}

impl<T, P, E> Default for ActiveContacts<T, P, E> {
    fn default() -> Self {
        Self {
            slots: Vec::new(),
            found: Vec::new(),
            met: Vec::new(),
            numbers: Numbers::default(),
            histories: Histories::default(),
            pushes: Vec::new(),
            energies: Vec::new(),
        }
    }
}

impl<T: Copy + Default + Send + Sync, P: Copy + Default + Send + Sync, E: BlockSum + Sync>
    ActiveContacts<T, P, E>
{
    /// Reserves slots for that many candidates. Unused ones are not touched: they take addresses, and no
    /// memory.
    pub fn reserve(&mut self, count: usize) {
        fn reserve_total<V>(list: &mut Vec<V>, count: usize) {
            list.reserve(count.saturating_sub(list.len()));
        }
        let blocks = block_count(count);
        reserve_total(&mut self.slots, count);
        reserve_total(&mut self.met, count);
        reserve_total(&mut self.pushes, count);
        reserve_total(&mut self.numbers.within, count);
        reserve_total(&mut self.numbers.first, blocks);
        reserve_total(&mut self.found, blocks);
        reserve_total(&mut self.energies, count);
        self.histories.reserve(count);
    }

    /// Finds out which candidates, ascending, touch. Returns what `test` adds up; it keeps an `S` from one
    /// candidate of a block to the next.
    pub fn find<S: Default>(
        &mut self,
        candidates: &[PairKey],
        test: impl Fn(PairKey, &mut E, &mut S) -> Option<T> + Sync,
    ) -> E {
        if self.slots.capacity() < candidates.len() {
            self.reserve(2 * candidates.len());
        }
        let Self { slots, found, numbers, .. } = self;
        slots.resize(slots.len().max(candidates.len()), Default::default());
        numbers.within.resize(candidates.len(), NONE);
        let slots = &mut slots[..candidates.len()];
        let rows = (candidates, &mut slots[..], &mut numbers.within[..]);
        type Rows<'a, T> = (&'a [PairKey], &'a mut [(PairKey, T)], &'a mut [u32]);
        let all = for_each_block_in_tasks(BLOCKS_OF_TEST, rows, found, &|_, rows: Rows<'_, T>| {
            let (mut found, mut kept) = (Found { count: 0, extra: E::default() }, S::default());
            let (candidates, slots, within) = rows;
            for (&key, number) in candidates.iter().zip(within) {
                *number = NONE;
                if let Some(met) = test(key, &mut found.extra, &mut kept) {
                    slots[found.count] = (key, met);
                    *number = found.count as u32;
                    found.count += 1;
                }
            }
            found
        });
        numbers.first.clear();
        let mut first = 0;
        for found in &*found {
            numbers.first.push(first);
            first += found.count as u32;
        }
        keep(slots, found, all.count, &mut self.met);
        all.extra
    }

    /// The contacts of the step.
    pub fn met(&self) -> &[(PairKey, T)] {
        &self.met
    }

    /// Which of them belongs to a candidate.
    pub fn numbers(&self) -> &Numbers {
        &self.numbers
    }

    /// Their forces.
    pub fn pushes(&self) -> &[P] {
        &self.pushes
    }

    /// Has all contacts of the step begin with what `begun` makes of them.
    pub fn begin(&mut self, begun: impl Fn(PairKey, &T) -> History) {
        self.histories.set(self.met.iter().map(|(key, met)| (*key, begun(*key, met))).collect());
    }

    /// Computes the force of every contact, with its history, and the end of those that have ended. Returns
    /// the energies and losses of all, added by the `nodes` of the first body.
    pub fn respond(
        &mut self,
        nodes: usize,
        each: impl Fn(PairKey, &T, &History, &mut ContactEnergy) -> (History, P) + Sync,
        end: impl Fn(PairKey, &History, &mut ContactEnergy) + Sync,
    ) -> ContactEnergy {
        let Self { met, pushes, histories, energies, .. } = self;
        pushes.resize(met.len(), P::default());
        let (old, new) = histories.generations(met.len());
        energies.clear();
        energies.resize(met.len(), ContactEnergy::default());
        let rows = (&met[..], new, &mut pushes[..], &mut energies[..]);
        type Rows<'a, T, P> =
            (&'a [(PairKey, T)], &'a mut [(PairKey, History)], &'a mut [P], &'a mut [ContactEnergy]);
        for_each_heavy_block(rows, &mut Vec::new(), &|_, (met, new, pushes, energies): Rows<'_, T, P>| {
            let mut old = PassedList::new(old, met[0].0);
            for ((((key, met), new), push), energy) in met.iter().zip(new).zip(pushes).zip(energies) {
                let before = old.at(*key).map_or(History::default(), |entry| entry.1);
                let (history, pushed) = each(*key, met, &before, energy);
                (*new, *push) = ((*key, history), pushed);
            }
        });
        let mut sum = sum_by_row(nodes, met.len(), &|k| met[k].0.0 as usize, &|k| energies[k]);
        let has_ended = old.len() != met.len() || old.iter().zip(&*met).any(|(old, met)| old.0 != met.0);
        if has_ended {
            sum.add(&ended(nodes, old, met, energies, &end));
        }
        self.histories.turn();
        sum
    }
}

/// The energies and losses of contacts that have ended: those of `old` that are not among those met, added by
/// the nodes of the first body.
fn ended<T: Sync>(
    nodes: usize,
    old: &[(PairKey, History)],
    met: &[(PairKey, T)],
    energies: &mut Vec<ContactEnergy>,
    end: &(impl Fn(PairKey, &History, &mut ContactEnergy) + Sync),
) -> ContactEnergy {
    energies.clear();
    energies.resize(old.len(), ContactEnergy::default());
    let rows = (old, &mut energies[..]);
    type Ended<'a> = (&'a [(PairKey, History)], &'a mut [ContactEnergy]);
    for_each_heavy_block(rows, &mut Vec::new(), &|_, (old, energies): Ended<'_>| {
        let mut met = PassedList::new(met, old[0].0);
        for ((key, history), energy) in old.iter().zip(energies) {
            if met.at(*key).is_none() {
                end(*key, history, energy);
            }
        }
    });
    sum_by_row(nodes, old.len(), &|k| old[k].0.0 as usize, &|k| energies[k])
}

/// A list, ascending by pair, that is passed through in its order.
struct PassedList<'a, V>(&'a [(PairKey, V)]);

impl<'a, V> PassedList<'a, V> {
    /// From that pair on.
    fn new(list: &'a [(PairKey, V)], from: PairKey) -> Self {
        Self(&list[list.partition_point(|entry| entry.0 < from)..])
    }

    /// The entry of a pair, if there is one. Pairs that are asked for ascend.
    fn at(&mut self, key: PairKey) -> Option<&'a (PairKey, V)> {
        while self.0.first().is_some_and(|entry| entry.0 < key) {
            self.0 = &self.0[1..];
        }
        self.0.first().filter(|entry| entry.0 == key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step in which these pairs touch; returns which were remembered, and which have ended.
    fn step(contacts: &mut ActiveContacts<u32, u32, ()>, touching: &[PairKey]) -> (Vec<PairKey>, usize) {
        let candidates: Vec<PairKey> = (0..200).flat_map(|i| [(i, 0), (i, 2)]).collect();
        contacts.find(&candidates, |key, (), (): &mut ()| touching.contains(&key).then_some(key.0 + key.1));
        assert!(contacts.met().iter().map(|met| met.0).eq(touching.iter().copied()));
        for (candidate, key) in (0..).zip(&candidates) {
            let number = contacts.numbers().of(candidate);
            assert_eq!(number, touching.iter().position(|touching| touching == key));
        }
        let energies = contacts.respond(
            200,
            |key, found, before, _| {
                assert_eq!(*found, key.0 + key.1);
                let overlap = if before.is_none() { 1.0 } else { before.overlap + 1.0 };
                (History { overlap, ..History::default() }, *found)
            },
            |_, _, energies| energies.stored += 1.0,
        );
        assert!(contacts.pushes().iter().copied().eq(touching.iter().map(|key| key.0 + key.1)));
        let entries = contacts.histories.entries().iter();
        let again = entries.filter(|entry| entry.1.overlap > 1.0).map(|entry| entry.0);
        (again.collect(), energies.stored as usize)
    }

    /// The energies of contacts of these pairs; those of nodes below 100 hold nothing.
    fn stored(pairs: &[PairKey]) -> ContactEnergy {
        let mut contacts = ActiveContacts::<(), (), ()>::default();
        contacts.find(pairs, |_, (), (): &mut ()| Some(()));
        contacts.respond(
            4_000,
            |(i, j), (), _, energies| {
                energies.stored = if i < 100 { 0.0 } else { (f64::from(i + 7 * j) * 0.7).sin() * 1e3 };
                Default::default()
            },
            |_, _, _| (),
        )
    }

    #[test]
    fn energies_do_not_depend_on_how_many_contacts_other_nodes_have() {
        let own = |i: u32| (0..1 + i % 3).map(move |j| (i, j));
        let some: Vec<PairKey> = (100..4_000).flat_map(own).collect();
        let more: Vec<PairKey> = (0..37).flat_map(own).chain(some.iter().copied()).collect();
        assert_eq!(stored(&some).stored.to_bits(), stored(&more).stored.to_bits());
    }

    #[test]
    fn contacts_that_end_are_met_once_and_others_are_remembered() {
        let mut contacts = ActiveContacts::default();
        assert_eq!(step(&mut contacts, &[(1, 0), (3, 2), (7, 0)]), (vec![], 0));
        assert_eq!(step(&mut contacts, &[(2, 2), (3, 2), (70, 0), (199, 2)]), (vec![(3, 2)], 2));
        assert_eq!(step(&mut contacts, &[]), (vec![], 4));
        let all: Vec<PairKey> = (0..200).map(|i| (i, 2)).collect();
        assert_eq!(step(&mut contacts, &all), (vec![], 0));
        assert_eq!(step(&mut contacts, &all[50..]), (all[50..].to_vec(), 50));
    }
}
