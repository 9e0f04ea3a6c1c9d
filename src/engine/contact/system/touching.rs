//! A pair of bodies with a contact.

use crate::contact::active::ContactNodes;
use crate::contact::bodies::{MemberParticles, MotionBounds, NodeTurn};
use crate::contact::particles::ParticleContact;
use crate::contact::response::{ContactEnergy, Histories, History, PairKey};
use crate::contact::skins::{SkinOnTool, SkinPair};
use crate::contact::tools::{CoupledResponse, SurfaceContact};
use crate::schedule::{Step, StepError};
use crate::skins::{Last, Patch};
use crate::world::BodyId;

/// Two bodies that touch.
pub(in crate::contact) enum Touching {
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

    /// Finds out what touches, where others are to know that.
    pub fn find(&mut self, step: &Step<'_>, motion: [MotionBounds; 2]) -> Result<(), StepError> {
        match self {
            Self::Surface(contact) => contact.find(step, motion),
            Self::Particles(_) | Self::SkinOnTool(_) | Self::Skins(_) => Ok(()),
        }
    }

    /// Which of the two contacts of a pair of rigid bodies it is; the second follows the first.
    pub fn turn(&self) -> NodeTurn {
        if let Self::Surface(contact) = self { contact.sides.turn } else { NodeTurn::Alone }
    }

    /// Response of two rigid bodies to its springs, as the other contact of the pair needs it.
    pub fn beside_the_other(&self) -> Option<CoupledResponse> {
        if let Self::Surface(contact) = self { Some(contact.together?.turned_around()) } else { None }
    }

    /// Computes the forces; `beside` are the contacts of the points of the second of two rigid bodies on the
    /// surface of the first.
    pub fn run(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
        beside: Option<CoupledResponse>,
    ) -> Result<ContactEnergy, StepError> {
        match self {
            Self::Particles(contact) => contact.run(step, motion),
            Self::Surface(contact) => contact.run(step, motion, beside),
            Self::SkinOnTool(contact) => contact.run(step, motion),
            Self::Skins(contact) => contact.run(step, motion),
        }
    }

    /// Computes the energies of skins, and nothing else: their forces do not act.
    pub fn held(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<ContactEnergy, StepError> {
        match self {
            Self::SkinOnTool(contact) => Ok(contact.evaluate(step, motion)?.0),
            Self::Skins(contact) => contact.run(step, motion),
            Self::Particles(_) | Self::Surface(_) => Ok(ContactEnergy::default()),
        }
    }

    /// Energy of the springs of active particle contacts, J.
    pub fn pressed(&mut self, step: &Step<'_>, motion: [MotionBounds; 2]) -> Result<f64, StepError> {
        match self {
            Self::Particles(contact) => contact.pressed(step, motion),
            Self::Surface(contact) => contact.pressed(step),
            Self::SkinOnTool(_) | Self::Skins(_) => Ok(0.0),
        }
    }

    /// Has particles that touch begin with that part of their overlaps.
    pub fn begin(&mut self, part: f64) {
        match self {
            Self::Particles(contact) => contact.begin(part),
            Self::Surface(contact) => contact.begin(part),
            Self::SkinOnTool(_) | Self::Skins(_) => {}
        }
    }

    /// The particles of both.
    pub fn particles(&self) -> impl Iterator<Item = &MemberParticles> {
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
    pub fn contact_nodes(&self) -> impl Iterator<Item = (BodyId, &ContactNodes)> {
        let [first, second] = self.bodies();
        match self {
            Self::Particles(contact) => {
                [Some((first, &contact.contact_nodes[0])), Some((second, &contact.contact_nodes[1]))]
            }
            Self::Surface(contact) => [Some((first, &contact.contact_nodes)), None],
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

    /// State in a checkpoint.
    pub fn saved(&self) -> Saved {
        let histories: &[&Histories] = match self {
            Self::Particles(contact) => &[&contact.contacts.histories],
            Self::Surface(contact) => &[&contact.contacts.histories],
            Self::SkinOnTool(contact) => &[&contact.contacts.histories],
            Self::Skins(contact) => &contact.passes.each_ref().map(|pass| &pass.histories),
        };
        let histories = histories.iter().map(|histories| histories.entries().to_vec()).collect();
        (histories, self.patches().iter().map(Patch::saved).collect())
    }

    pub fn restore(&mut self, (histories, patches): Saved) -> bool {
        let own: &mut [&mut Histories] = match self {
            Self::Particles(contact) => &mut [&mut contact.contacts.histories],
            Self::Surface(contact) => &mut [&mut contact.contacts.histories],
            Self::SkinOnTool(contact) => &mut [&mut contact.contacts.histories],
            Self::Skins(contact) => &mut contact.passes.each_mut().map(|pass| &mut pass.histories),
        };
        if own.len() != histories.len() {
            return false;
        }
        own.iter_mut().zip(histories).for_each(|(own, entries)| own.set(entries));
        let own: &mut [Patch] = match self {
            Self::SkinOnTool(contact) => std::slice::from_mut(&mut contact.patch),
            Self::Skins(contact) => &mut contact.patches,
            Self::Particles(_) | Self::Surface(_) => &mut [],
        };
        own.iter_mut().zip(&patches).for_each(|(own, saved)| own.restore(saved));
        own.len() == patches.len()
    }
}

/// Histories and the last places of skins.
pub(super) type Saved = (Vec<Vec<(PairKey, History)>>, Vec<Vec<(u32, Last)>>);
