//! Two clocks in one step: stiff bodies take several sub-steps in one long step of the rest.

use crate::world::{BodyId, BodySet, PhaseId, World};

/// When a system runs in a step in which some phases are sub-cycled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cadence {
    /// Once: it touches phases that are not sub-cycled, or says so by
    /// [`System::in_long_steps`](super::System::in_long_steps).
    Long,
    /// In every sub-step: all phases that it touches are sub-cycled.
    Short,
    /// In both, each time with the bodies that are due: see [`System::by_body`](super::System::by_body).
    Both,
}

/// Which part of a step runs now: the long step, or one of the sub-steps in it.
#[derive(Clone, Copy, Debug)]
pub struct StepPart<'s> {
    short: bool,
    long: Option<f64>,
    divided: bool,
    last: bool,
    number: u64,
    sub_cycled: &'s [PhaseId],
}

impl<'s> StepPart<'s> {
    /// The long step of this number, `divided` into several sub-steps or not; without sub-cycled phases, the
    /// whole of the step.
    pub fn long(sub_cycled: &'s [PhaseId], divided: bool, number: u64) -> Self {
        Self { short: false, long: None, divided, last: true, number, sub_cycled }
    }

    /// The sub-step of this number since time 0; `long` is the length of the long step, s, where there are
    /// others in it, of which this is the `last` one or not.
    pub fn short(sub_cycled: &'s [PhaseId], long: Option<f64>, last: bool, number: u64) -> Self {
        Self { short: true, long, divided: long.is_some(), last, number, sub_cycled }
    }

    /// Number of steps done before this one by the clock of this part of the step: sub-steps by that of
    /// sub-cycled phases. Systems of sub-cycled bodies that act every so many steps count by this.
    pub fn number(self) -> u64 {
        self.number
    }

    /// Length of the long step of which this is one of several sub-steps, s.
    pub fn long_step(self) -> Option<f64> {
        self.long
    }

    /// Whether the long step has several sub-steps: known to what ends it.
    pub fn is_divided(self) -> bool {
        self.divided
    }

    /// Whether it ends the long step for what moves in it: the last sub-step does, and the long step itself.
    pub fn is_last(self) -> bool {
        self.last
    }

    /// Whether the bodies of a phase move in this part of the step.
    pub fn moves(self, phase: PhaseId) -> bool {
        self.sub_cycled.contains(&phase) == self.short
    }

    /// Whether the body moves in this part of the step.
    pub fn is_due(self, world: &World, body: BodyId) -> bool {
        self.moves(world.body(body).phase)
    }

    /// The bodies of a set that move in this part of the step.
    pub fn due(self, world: &'s World, bodies: &BodySet) -> impl Iterator<Item = BodyId> {
        bodies.iter().filter(move |&body| self.is_due(world, body))
    }

    /// Whether a system of this cadence runs now.
    pub(super) fn has(self, cadence: Cadence) -> bool {
        match cadence {
            Cadence::Long => !self.short,
            Cadence::Short => self.short,
            Cadence::Both => true,
        }
    }
}
