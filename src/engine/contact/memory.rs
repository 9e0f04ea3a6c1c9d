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
    /// From the particles of both sides to where the forces act, in the reference configuration, m.
    pub arms: [DVec3; 2],
}

impl Memory {
    /// Energy in the tangential spring, J.
    pub fn energy(&self) -> f64 {
        if self.stiffness > 0.0 { 0.5 * self.spring.length_squared() / self.stiffness } else { 0.0 }
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
    /// Entries of `now` that have been passed.
    passed: usize,
}

impl Memories {
    /// The next entry of the last step whose pair comes before `key`: a contact that has ended.
    pub fn ended_before(&mut self, key: Option<PairKey>) -> Option<(PairKey, Memory)> {
        let entry = *self.now.get(self.passed)?;
        let ended = key.is_none_or(|key| entry.0 < key);
        self.passed += usize::from(ended);
        ended.then_some(entry)
    }

    /// What the contact remembers, if it was there in the last step. Ask in ascending order of pairs, after
    /// [`Memories::ended_before`].
    pub fn of(&mut self, key: PairKey) -> Memory {
        match self.now.get(self.passed) {
            Some(entry) if entry.0 == key => {
                self.passed += 1;
                entry.1
            }
            _ => Memory::default(),
        }
    }

    /// Keeps what the contact will remember in the next step.
    pub fn keep(&mut self, key: PairKey, memory: Memory) {
        self.next.push((key, memory));
    }

    /// Ends the step.
    pub fn turn(&mut self) {
        std::mem::swap(&mut self.now, &mut self.next);
        self.next.clear();
        self.passed = 0;
    }

    /// The contacts of the last step.
    pub fn entries(&self) -> &[(PairKey, Memory)] {
        &self.now
    }

    /// Takes up the contacts of a checkpoint.
    pub fn set(&mut self, entries: Vec<(PairKey, Memory)>) {
        self.now = entries;
        self.next.clear();
        self.passed = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strong(stiffness: f64) -> Memory {
        Memory { stiffness, ..Memory::default() }
    }

    #[test]
    fn contacts_that_end_are_met_once_and_others_are_found() {
        let mut memories = Memories::default();
        for (key, k) in [((1, 0), 1.0), ((3, 2), 3.0), ((7, 0), 7.0)] {
            memories.keep(key, strong(k));
        }
        memories.turn();
        let mut ended = Vec::new();
        for key in [(2, 9), (3, 2), (5, 0)] {
            while let Some((old, _)) = memories.ended_before(Some(key)) {
                ended.push(old);
            }
            let expected = if key == (3, 2) { 3.0 } else { 0.0 };
            assert_eq!(memories.of(key).stiffness, expected);
            memories.keep(key, strong(1.0));
        }
        while let Some((old, _)) = memories.ended_before(None) {
            ended.push(old);
        }
        assert_eq!(ended, [(1, 0), (7, 0)]);
        memories.turn();
        assert_eq!(memories.entries().len(), 3);
    }
}
