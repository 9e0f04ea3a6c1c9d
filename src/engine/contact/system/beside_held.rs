//! Warning of contact that reaches a side held along its normal alone: the stress beside the edge is wrong
//! there, as under a load.

use crate::plugin::{BodyPlan, HeldSide};
use crate::schedule::Step;
use crate::skins::Patch;
use crate::world::BodyId;

/// Share of the largest force on a particle from which contact counts, and share of a force along the normal
/// of the side up to which it is across that.
const COUNTS: f64 = 0.1;
const ACROSS: f64 = 0.7;

/// A side of a body in contact that is held along its normal.
pub(super) struct ReachedSide {
    body: BodyId,
    axis: usize,
    /// The particles on it, by their numbers, ascending.
    particles: Vec<u32>,
    warning: String,
    is_told: bool,
}

impl ReachedSide {
    /// The held sides of a body.
    pub fn of(body: &BodyPlan) -> impl Iterator<Item = Self> + '_ {
        let of_side = |side: &HeldSide| {
            let warning = side.reached_by(&format!("contact on body `{}`", body.name))?;
            let particles = side.moved.iter().map(|(number, _)| *number).collect();
            Some(Self { body: body.id, axis: side.plane.0, particles, warning, is_told: false })
        };
        body.sides.iter().filter_map(of_side)
    }

    /// Checks whether a particle on the side carries a notable force of a patch tangential to the side, and
    /// warns once.
    pub fn look(&mut self, patch: &Patch, step: &mut Step<'_>) {
        if self.is_told || patch.skin.body != self.body {
            return;
        }
        let largest = patch.on_particles().map(|(_, force, _)| force.length()).fold(0.0, f64::max);
        let reaches = patch.on_particles().any(|(particle, force, _)| {
            let size = force.length();
            size > COUNTS * largest
                && force[self.axis].abs() < ACROSS * size
                && self.particles.binary_search(&(particle as u32)).is_ok()
        });
        if reaches {
            self.is_told = true;
            step.warnings.push(std::mem::take(&mut self.warning));
        }
    }
}
