//! Contact history: values of a contact kept from one step to the next, by pair.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Which contact: number of a node of the first body, and number of a node of the second, or zero for its
/// surface.
pub(in crate::contact) type PairKey = (u32, u32);

/// History of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::contact) struct History {
    /// Force of the tangential spring on the first side, N.
    pub spring: DVec3,
    /// Stiffness of that spring, N/m.
    pub stiffness: f64,
    /// Force of the dashpots on the first side, N.
    pub dashpot: DVec3,
    /// Depth of the overlap, m; zero where there was none.
    pub overlap: f64,
    /// How much deeper the sides overlap, m: what took over from other springs begins with the energy of
    /// these.
    pub offset: f64,
    /// From the particles of both sides to where the forces act, in the reference configuration, m.
    pub arms: [DVec3; 2],
    /// Force along the normal, N.
    pub pressure: f64,
    /// Whether the tangential force is at Coulomb's limit.
    pub slides: bool,
}

impl History {
    /// Energy in the tangential spring, J.
    pub fn energy(&self) -> f64 {
        if self.stiffness > 0.0 { 0.5 * self.spring.length_squared() / self.stiffness } else { 0.0 }
    }

    /// A contact of that overlap, m, that takes over from other springs with a part of it.
    pub fn begun(overlap: f64, part: f64) -> Self {
        Self { offset: (1.0 - part) * overlap, ..Self::default() }
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

/// The histories of all contacts of two bodies, ascending by pair. A new generation is written while the old
/// one is read: contacts that are not written again have ended.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Histories {
    now: Vec<(PairKey, History)>,
    next: Vec<(PairKey, History)>,
}

impl Histories {
    /// Allocates memory for that many contacts.
    pub fn reserve(&mut self, count: usize) {
        for entries in [&mut self.now, &mut self.next] {
            entries.reserve(count.saturating_sub(entries.len()));
        }
    }

    /// The contacts of the last step, and memory for those of this one.
    pub fn generations(&mut self, count: usize) -> (&[(PairKey, History)], &mut [(PairKey, History)]) {
        self.next.resize(count, Default::default());
        (&self.now, &mut self.next)
    }

    /// Ends the step.
    pub fn turn(&mut self) {
        std::mem::swap(&mut self.now, &mut self.next);
    }

    /// Whether there was no contact in the last step.
    pub fn is_empty(&self) -> bool {
        self.now.is_empty()
    }

    /// The contacts of the last step.
    pub fn entries(&self) -> &[(PairKey, History)] {
        &self.now
    }

    /// Restores the contacts of a checkpoint.
    pub fn set(&mut self, entries: Vec<(PairKey, History)>) {
        self.now = entries;
    }
}
