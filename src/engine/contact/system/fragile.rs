//! Bodies that can fail have contact through their skins as long as all particles that carry these are
//! intact, and from then on through their particles.
//!
//! The step in which the first particle of a skin fails computes both, at the same positions. Particles
//! protrude from a body that is compressed along its surface, because those of a body that can fail stay
//! spheres: with their full overlaps they would store more energy than the skin did, and supply spurious
//! energy. They therefore start with reduced overlaps, for which they store the energy of the skin. The
//! forces are those of the particles, and the remaining difference goes to the account `contact_surface`.

use std::sync::Arc;

use super::touching::Touching;
use crate::contact::bodies::{BUMPS, MotionBounds};
use crate::contact::response::ContactEnergy;
use crate::notation::quantity;
use crate::schedule::{Step, StepError};
use crate::skins::Skin;
use crate::world::{BodyId, Damage};

/// When a contact acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::contact) enum ContactActivity {
    Always,
    /// For as long as the skins of these fragile bodies are whole.
    WhileWhole(usize),
    /// As soon as one of them is broken.
    OnceBroken(usize),
}

/// The state of the skins of two bodies.
#[derive(Clone, Copy, PartialEq, Eq)]
enum SkinState {
    Whole,
    /// Broken in this step.
    Breaking,
    Broken,
}

/// The skins of two bodies in contact, of which one or both can fail.
pub(in crate::contact) struct FailingSkins {
    carriers: Vec<Carriers>,
    state: SkinState,
}

/// The particles that carry the skin of a body that can fail.
struct Carriers {
    body: BodyId,
    particles: Vec<u32>,
}

impl Carriers {
    fn of(skin: &Skin) -> Self {
        Self { body: skin.body, particles: skin.particles() }
    }

    /// Whether one of them has failed.
    fn have_failed(&self, step: &Step<'_>) -> Result<bool, StepError> {
        let (view, rows) = step.world.body_view(self.body);
        let damage = view.read_near::<Damage>()?;
        Ok(self.particles.iter().any(|&particle| damage[rows.start + particle as usize].0 >= 1.0))
    }
}

impl FailingSkins {
    /// Of the skins of bodies that can fail.
    pub fn new(skins: &[Arc<Skin>]) -> Self {
        Self { carriers: skins.iter().map(|skin| Carriers::of(skin)).collect(), state: SkinState::Whole }
    }

    /// Checks whether a particle of an intact skin has failed in this step, and warns.
    pub fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        if self.state != SkinState::Whole {
            self.state = SkinState::Broken;
            return Ok(());
        }
        for carriers in &self.carriers {
            if !carriers.have_failed(step)? {
                continue;
            }
            self.state = SkinState::Breaking;
            let told = format!(
                "body `{}` touches with its particles and no longer with its surface from {} on, because particles of that surface have failed; {BUMPS}",
                step.world.body(carriers.body).name,
                quantity(step.clock.end(), "s")
            );
            // Once for all contacts of the body.
            if !step.warnings.contains(&told) {
                step.warnings.push(told);
            }
        }
        Ok(())
    }

    /// Whether the skins are whole.
    pub fn is_whole(&self) -> bool {
        self.state == SkinState::Whole
    }

    /// Whether they break in this step: the first in which the particles act.
    pub fn is_breaking(&self) -> bool {
        self.state == SkinState::Breaking
    }

    /// Whether they are not whole any more.
    pub fn restore(&mut self, is_whole: bool) {
        self.state = if is_whole { SkinState::Whole } else { SkinState::Broken };
    }
}

impl ContactActivity {
    /// Whether a contact that acts so does it in this step.
    pub fn now(self, fragile: &[FailingSkins]) -> bool {
        match self {
            Self::Always => true,
            Self::WhileWhole(k) => fragile[k].is_whole(),
            Self::OnceBroken(k) => !fragile[k].is_whole(),
        }
    }

    /// Whether this is the first step in which a contact acts.
    pub fn begins(self, fragile: &[FailingSkins]) -> bool {
        matches!(self, Self::OnceBroken(k) if fragile[k].is_breaking())
    }
}

/// Starts the contacts of particles that replace the skins of that number with the energy of these; returns
/// the two bodies, and the released energies.
pub(super) fn break_skins(
    number: usize,
    touching: &mut [Touching],
    acts: &[ContactActivity],
    step: &mut Step<'_>,
    motion_of: &dyn Fn(usize) -> [MotionBounds; 2],
) -> Result<((BodyId, BodyId), ContactEnergy), StepError> {
    let mut bodies = (BodyId(0), BodyId(0));
    let (mut held, mut pressed) = (ContactEnergy::default(), 0.0);
    for (k, (pair, acts)) in touching.iter_mut().zip(acts).enumerate() {
        if *acts == ContactActivity::WhileWhole(number) {
            bodies = pair.bodies().into();
            pair.come_near();
            held = pair.held(step, motion_of(k))?;
        } else if *acts == ContactActivity::OnceBroken(number) {
            pressed += pair.pressed(step, motion_of(k))?;
        }
    }
    // The energy of a spring goes with the square of its overlap, and faster where it hardens.
    let part = if pressed > held.stored { (held.stored / pressed).sqrt() } else { 1.0 };
    for (pair, acts) in touching.iter_mut().zip(acts) {
        if *acts == ContactActivity::OnceBroken(number) {
            pair.begin(part);
        }
    }
    Ok((bodies, held.given_up()))
}
