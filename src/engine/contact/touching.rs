//! Two bodies that touch.

use super::members::Particles;
use super::memory::Memories;
use super::pace::Pace;
use super::particles::ParticleContact;
use super::surface::SurfaceContact;
use super::tally::Tally;
use super::touched::Touched;
use crate::schedule::{Step, StepError};
use crate::world::BodyId;

/// Two bodies that touch.
pub(super) enum Touching {
    Particles(Box<ParticleContact>),
    Surface(Box<SurfaceContact>),
}

impl Touching {
    /// The two bodies.
    pub fn bodies(&self) -> [BodyId; 2] {
        match self {
            Self::Particles(contact) => [contact.first.body, contact.second.body],
            Self::Surface(contact) => [contact.sides.first, contact.sides.second],
        }
    }

    pub fn run(&mut self, step: &mut Step<'_>, paces: [Pace; 2]) -> Result<Tally, StepError> {
        match self {
            Self::Particles(contact) => contact.run(step, paces),
            Self::Surface(contact) => contact.run(step, paces),
        }
    }

    /// The particles of both.
    pub fn particles(&self) -> impl Iterator<Item = &Particles> {
        let (first, second) = match self {
            Self::Particles(contact) => (Some(&contact.first), Some(&contact.second)),
            Self::Surface(contact) => (contact.sides.nodes.particles(), None),
        };
        first.into_iter().chain(second)
    }

    /// The particles of both that touch.
    pub fn touched(&self) -> impl Iterator<Item = (BodyId, &Touched)> {
        let [first, second] = self.bodies();
        match self {
            Self::Particles(contact) => {
                [Some((first, &contact.touched[0])), Some((second, &contact.touched[1]))]
            }
            Self::Surface(contact) => [Some((first, &contact.touched)), None],
        }
        .into_iter()
        .flatten()
    }

    pub fn memories(&self) -> &Memories {
        match self {
            Self::Particles(contact) => &contact.meetings.memories,
            Self::Surface(contact) => &contact.meetings.memories,
        }
    }

    pub fn memories_mut(&mut self) -> &mut Memories {
        match self {
            Self::Particles(contact) => &mut contact.meetings.memories,
            Self::Surface(contact) => &mut contact.meetings.memories,
        }
    }
}
