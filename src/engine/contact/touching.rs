//! Two bodies that touch.

use super::members::Particles;
use super::memory::{Memories, Memory, PairKey};
use super::pace::Pace;
use super::particles::ParticleContact;
use super::skin_on_tool::SkinOnTool;
use super::skin_pair::SkinPair;
use super::surface::SurfaceContact;
use super::tally::Tally;
use super::touched::Touched;
use crate::schedule::{Step, StepError};
use crate::skins::{Last, Patch};
use crate::world::BodyId;

/// Two bodies that touch.
pub(super) enum Touching {
    Particles(Box<ParticleContact>),
    Surface(Box<SurfaceContact>),
    SkinOnTool(Box<SkinOnTool>),
    Skins(Box<SkinPair>),
}

impl Touching {
    /// The two bodies.
    pub fn bodies(&self) -> [BodyId; 2] {
        match self {
            Self::Particles(contact) => [contact.first.body, contact.second.body],
            Self::Surface(contact) => [contact.sides.first, contact.sides.second],
            Self::SkinOnTool(contact) => [contact.patch.skin.body, contact.tool],
            Self::Skins(contact) => [0, 1].map(|k| contact.patches[k].skin.body),
        }
    }

    pub fn run(&mut self, step: &mut Step<'_>, paces: [Pace; 2]) -> Result<Tally, StepError> {
        match self {
            Self::Particles(contact) => contact.run(step, paces),
            Self::Surface(contact) => contact.run(step, paces),
            Self::SkinOnTool(contact) => contact.run(step, paces),
            Self::Skins(contact) => contact.run(step, paces),
        }
    }

    /// The particles of both.
    pub fn particles(&self) -> impl Iterator<Item = &Particles> {
        let (first, second) = match self {
            Self::Particles(contact) => (Some(&contact.first), Some(&contact.second)),
            Self::Surface(contact) => (contact.sides.nodes.particles(), None),
            Self::SkinOnTool(_) | Self::Skins(_) => (None, None),
        };
        first.into_iter().chain(second)
    }

    /// Whether what touches follows the deformation of bodies, and acts on the material beside particles.
    pub fn deforms(&self) -> bool {
        !self.patches().is_empty() || self.particles().any(|particles| particles.deform)
    }

    /// The particles of both that touch.
    pub fn touched(&self) -> impl Iterator<Item = (BodyId, &Touched)> {
        let [first, second] = self.bodies();
        match self {
            Self::Particles(contact) => {
                [Some((first, &contact.touched[0])), Some((second, &contact.touched[1]))]
            }
            Self::Surface(contact) => [Some((first, &contact.touched)), None],
            Self::SkinOnTool(_) | Self::Skins(_) => [None, None],
        }
        .into_iter()
        .flatten()
    }

    /// The patches of skins that touch.
    pub fn patches(&self) -> &[Patch] {
        match self {
            Self::SkinOnTool(contact) => std::slice::from_ref(&contact.patch),
            Self::Skins(contact) => &contact.patches,
            Self::Particles(_) | Self::Surface(_) => &[],
        }
    }

    /// What a checkpoint keeps.
    pub fn saved(&self) -> Saved {
        let memories: &[&Memories] = match self {
            Self::Particles(contact) => &[&contact.meetings.memories],
            Self::Surface(contact) => &[&contact.meetings.memories],
            Self::SkinOnTool(contact) => &[&contact.meetings.memories],
            Self::Skins(contact) => &contact.passes.each_ref().map(|pass| &pass.memories),
        };
        let memories = memories.iter().map(|memories| memories.entries().to_vec()).collect();
        (memories, self.patches().iter().map(Patch::saved).collect())
    }

    pub fn restore(&mut self, (memories, patches): Saved) -> bool {
        let own: &mut [&mut Memories] = match self {
            Self::Particles(contact) => &mut [&mut contact.meetings.memories],
            Self::Surface(contact) => &mut [&mut contact.meetings.memories],
            Self::SkinOnTool(contact) => &mut [&mut contact.meetings.memories],
            Self::Skins(contact) => &mut contact.passes.each_mut().map(|pass| &mut pass.memories),
        };
        if own.len() != memories.len() {
            return false;
        }
        own.iter_mut().zip(memories).for_each(|(own, entries)| own.set(entries));
        let own: &mut [Patch] = match self {
            Self::SkinOnTool(contact) => std::slice::from_mut(&mut contact.patch),
            Self::Skins(contact) => &mut contact.patches,
            Self::Particles(_) | Self::Surface(_) => &mut [],
        };
        own.iter_mut().zip(&patches).for_each(|(own, saved)| own.restore(saved));
        own.len() == patches.len()
    }
}

/// Memories and the last places of skins.
pub(super) type Saved = (Vec<Vec<(PairKey, Memory)>>, Vec<Vec<(u32, Last)>>);
