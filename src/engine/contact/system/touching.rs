//! A pair of bodies with a contact.

use std::sync::Arc;

use crate::contact::active::ContactNodes;
use crate::contact::bodies::{MemberParticles, MotionBounds, NodeTurn};
use crate::contact::particles::ParticleContact;
use crate::contact::response::{ContactEnergy, Histories, History, PairKey};
use crate::contact::skins::{SkinContact, SkinOnTool, SkinPair};
use crate::contact::tools::{CoupledResponse, SurfaceContact};
use crate::schedule::{Step, StepError};
use crate::skins::{Last, Patch, Skin};
use crate::world::BodyId;

/// Two bodies that touch.
pub(in crate::contact) enum Touching {
    Particles(Box<ParticleContact>),
    Surface(Box<SurfaceContact>),
    SkinOnTool(Box<SkinOnTool>),
    Skins(Box<SkinContact>),
}

impl Touching {
    /// The two bodies.
    pub fn bodies(&self) -> [BodyId; 2] {
        match self {
            Self::Particles(contact) => [contact.first.body, contact.second.body],
            Self::Surface(contact) => [contact.sides.first, contact.sides.second],
            Self::SkinOnTool(contact) => [contact.patch.skin.body, contact.tool],
            Self::Skins(contact) => contact.skins.each_ref().map(|skin| skin.body),
        }
    }

    /// Distance at which particles just touch, m; none between rigid bodies.
    pub fn reach(&self) -> Option<f64> {
        match self {
            Self::Particles(contact) => Some(contact.first.min_radius() + contact.second.min_radius()),
            Self::Surface(contact) => Some(2.0 * contact.sides.nodes.particles()?.min_radius()),
            Self::SkinOnTool(contact) => Some(contact.patch.skin.spacing),
            Self::Skins(contact) => Some(contact.skins[0].spacing.min(contact.skins[1].spacing)),
        }
    }

    /// Whether nothing touches, and nothing is so near that it may.
    pub fn is_idle(&self) -> bool {
        match self {
            Self::Particles(contact) => contact.is_idle(),
            Self::Surface(contact) => contact.is_idle(),
            Self::SkinOnTool(contact) => contact.is_idle(),
            Self::Skins(contact) => contact.known().is_none_or(SkinPair::is_idle),
        }
    }

    /// Ends a time in which both were apart: what may touch has to be searched again.
    pub fn come_near(&mut self) {
        match self {
            Self::Particles(contact) => contact.forget(),
            Self::Surface(contact) => contact.forget(),
            Self::SkinOnTool(contact) => contact.forget(),
            Self::Skins(contact) => contact.near().forget(),
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
        if let Self::Surface(contact) = self {
            Some(contact.known()?.together?.turned_around())
        } else {
            None
        }
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
            Self::Skins(contact) => contact.near().run(step, motion),
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
            Self::Skins(contact) => contact.near().run(step, motion),
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

    /// The skins of both.
    pub fn skins(&self) -> &[Arc<Skin>] {
        match self {
            Self::SkinOnTool(contact) => std::slice::from_ref(&contact.patch.skin),
            Self::Skins(contact) => &contact.skins,
            Self::Particles(_) | Self::Surface(_) => &[],
        }
    }

    /// Whether what touches follows the deformation of bodies, and acts on the material beside particles.
    pub fn deforms(&self) -> bool {
        !self.skins().is_empty() || self.particles().any(|particles| particles.deform)
    }

    /// The particles of both that touch.
    pub fn contact_nodes(&self) -> impl Iterator<Item = (BodyId, &ContactNodes)> {
        let [first, second] = self.bodies();
        match self {
            Self::Particles(contact) => {
                [Some((first, &contact.contact_nodes[0])), Some((second, &contact.contact_nodes[1]))]
            }
            Self::Surface(contact) => [contact.known().map(|near| (first, &near.contact_nodes)), None],
            Self::SkinOnTool(_) | Self::Skins(_) => [None, None],
        }
        .into_iter()
        .flatten()
    }

    /// The patches of skins that touch.
    pub fn patches(&self) -> &[Patch] {
        match self {
            Self::SkinOnTool(contact) => std::slice::from_ref(&contact.patch),
            Self::Skins(contact) => contact.known().map_or(&[], |pair| &pair.patches),
            Self::Particles(_) | Self::Surface(_) => &[],
        }
    }

    /// State in a checkpoint: nothing where nothing touches.
    pub fn saved(&self) -> Saved {
        let histories: &[&Histories] = match self {
            Self::Particles(contact) => &[&contact.contacts.histories],
            Self::Surface(contact) => match contact.known() {
                Some(near) => &[&near.contacts.histories],
                None => &[],
            },
            Self::SkinOnTool(contact) => &[&contact.contacts.histories],
            Self::Skins(contact) => match contact.known() {
                Some(pair) => &pair.passes.each_ref().map(|pass| &pass.histories),
                None => &[],
            },
        };
        let histories: Vec<_> = histories.iter().map(|histories| histories.entries().to_vec()).collect();
        let patches: Vec<_> = self.patches().iter().map(Patch::saved).collect();
        let is_told = matches!(self, Self::SkinOnTool(contact) if contact.told);
        let is_empty = histories.iter().all(Vec::is_empty) && patches.iter().all(Vec::is_empty);
        if is_empty { (Vec::new(), Vec::new(), is_told) } else { (histories, patches, is_told) }
    }

    pub fn restore(&mut self, (histories, patches, is_told): Saved) -> bool {
        if let Self::SkinOnTool(contact) = self {
            contact.told = is_told;
        }
        if histories.is_empty() && patches.is_empty() {
            let (own, patches, _) = self.saved();
            return own.is_empty() && patches.is_empty();
        }
        let own: &mut [&mut Histories] = match self {
            Self::Particles(contact) => &mut [&mut contact.contacts.histories],
            Self::Surface(contact) => &mut [&mut contact.near().contacts.histories],
            Self::SkinOnTool(contact) => &mut [&mut contact.contacts.histories],
            Self::Skins(contact) => &mut contact.near().passes.each_mut().map(|pass| &mut pass.histories),
        };
        if own.len() != histories.len() {
            return false;
        }
        own.iter_mut().zip(histories).for_each(|(own, entries)| own.set(entries));
        let own: &mut [Patch] = match self {
            Self::SkinOnTool(contact) => std::slice::from_mut(&mut contact.patch),
            Self::Skins(contact) => &mut contact.near().patches,
            Self::Particles(_) | Self::Surface(_) => &mut [],
        };
        own.iter_mut().zip(&patches).for_each(|(own, saved)| own.restore(saved));
        own.len() == patches.len()
    }
}

/// Histories, the last places of skins, and whether the user has been warned.
pub(super) type Saved = (Vec<Vec<(PairKey, History)>>, Vec<Vec<(u32, Last)>>, bool);
