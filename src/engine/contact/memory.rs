//! What a contact remembers from one step to the next, by its pair.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Which contact: number of a node of the first body, and number of a node of the second, or zero for its surface.
pub(super) type PairKey = (u32, u32);

/// What a contact remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Memory {
    /// Force of the tangential spring on the first side, N.
    pub spring: DVec3,
    /// Stiffness of that spring, N/m.
    pub stiffness: f64,
    /// Force of the dashpots on the first side, N.
    pub dashpot: DVec3,
    /// Depth of the overlap, m; zero where there was none.
    pub overlap: f64,
    /// From the particles of both sides to where the forces act, in the reference configuration, m.
    pub arms: [DVec3; 2],
}

impl Memory {
    /// Energy in the tangential spring, J.
    pub fn energy(&self) -> f64 {
        if self.stiffness > 0.0 { 0.5 * self.spring.length_squared() / self.stiffness } else { 0.0 }
    }

    /// Whether the contact was not there.
    pub fn is_none(&self) -> bool {
        self.overlap == 0.0
    }

    /// Whether there is nothing but an elastic force.
    pub fn is_elastic(&self) -> bool {
        self.spring == DVec3::ZERO && self.dashpot == DVec3::ZERO
    }
}

/// The memories of all contacts of two bodies, ascending by pair. A new generation is written while the old one is
/// read: what is not written again has ended.
#[derive(Clone, Debug, Default)]
pub(super) struct Memories {
    now: Vec<(PairKey, Memory)>,
    next: Vec<(PairKey, Memory)>,
    /// Where in `now` the contacts of `next` were in the last step.
    before: Vec<Option<u32>>,
    /// Entries of `now` that have ended.
    ended: Vec<u32>,
}

/// The memories of the contacts of a step: for each where its old one is, the old ones, and room for the new ones.
pub(super) struct Remembered<'a> {
    pub before: &'a [Option<u32>],
    pub old: &'a [(PairKey, Memory)],
    pub new: &'a mut [(PairKey, Memory)],
}

impl Memories {
    /// Makes room for that many contacts.
    pub fn reserve(&mut self, count: usize) {
        let room = |entries: &mut Vec<_>| entries.reserve(count.saturating_sub(entries.len()));
        room(&mut self.now);
        room(&mut self.next);
        self.before.reserve(count.saturating_sub(self.before.len()));
        self.ended.reserve(count.saturating_sub(self.ended.len()));
    }

    /// Begins a step with contacts of these pairs, ascending.
    pub fn begin(&mut self, keys: impl Iterator<Item = PairKey>) -> Remembered<'_> {
        self.before.clear();
        self.ended.clear();
        self.next.clear();
        let mut passed = 0;
        for key in keys {
            while self.now.get(passed).is_some_and(|entry| entry.0 < key) {
                self.ended.push(passed as u32);
                passed += 1;
            }
            let known = self.now.get(passed).is_some_and(|entry| entry.0 == key);
            self.before.push(known.then_some(passed as u32));
            passed += usize::from(known);
            self.next.push((key, Memory::default()));
        }
        self.ended.extend(passed as u32..self.now.len() as u32);
        Remembered { before: &self.before, old: &self.now, new: &mut self.next }
    }

    /// Contacts of the last step that have ended.
    pub fn ended(&self) -> impl Iterator<Item = &(PairKey, Memory)> {
        self.ended.iter().map(|&k| &self.now[k as usize])
    }

    /// Ends the step.
    pub fn turn(&mut self) {
        std::mem::swap(&mut self.now, &mut self.next);
    }

    /// The contacts of the last step.
    pub fn entries(&self) -> &[(PairKey, Memory)] {
        &self.now
    }

    /// Takes up the contacts of a checkpoint.
    pub fn set(&mut self, entries: Vec<(PairKey, Memory)>) {
        self.now = entries;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contacts_that_end_are_met_once_and_others_are_found() {
        let mut memories = Memories::default();
        for entry in memories.begin([(1, 0), (3, 2), (7, 0)].into_iter()).new {
            entry.1.stiffness = f64::from(entry.0.0);
        }
        memories.turn();
        let found = memories.begin([(2, 9), (3, 2), (5, 0)].into_iter());
        assert_eq!(found.before, [None, Some(1), None]);
        assert_eq!(found.old[1].1.stiffness, 3.0);
        assert!(memories.ended().map(|entry| entry.0).eq([(1, 0), (7, 0)]));
        memories.turn();
        assert_eq!(memories.entries().len(), 3);
    }
}
