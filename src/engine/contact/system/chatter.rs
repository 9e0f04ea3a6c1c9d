//! Warning of chatter: points that slide stick again and again, because friction drives vibrations that
//! nothing damps. Friction then falls short of Coulomb's.
//!
//! Points that slide stick once as a body comes to rest, and once in each passage of a rolling body; those of
//! bodies that chatter do so every period of a vibration, some hundred steps. A sum of what sticks in excess
//! of a small rate (E. S. Page, Biometrika 41 (1954) 100) grows in the latter case only.

use serde::{Deserialize, Serialize};

use crate::contact::response::Sliding;
use crate::notation::quantity;
use crate::rigid::is_rigid;
use crate::schedule::Step;
use crate::world::BodyId;

/// Steps over which the force of what slides is averaged.
const AVERAGE: f64 = 100.0;
/// Share of the mean normal force at points that slide, above which a contact slides.
const SLIDES: f64 = 0.3;
/// How often a point may stick in a step.
const RATE: f64 = 1.0 / 500.0;
/// How often, beyond that, until there is a warning.
const TIMES: f64 = 20.0;

/// Whether a contact chatters.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Chatter {
    /// Mean normal force of all points, N.
    load: f64,
    /// That of points that slide, N. A body that bounces slides for a moment each time that it is nearly
    /// unloaded: that is a large share of the time, and a small one of the force.
    slides: f64,
    /// How often its points have stuck, beyond what is usual.
    times: f64,
    is_told: bool,
}

impl Chatter {
    /// Takes in a step of a contact of these bodies, and warns once.
    pub fn look(&mut self, bodies: [BodyId; 2], sliding: &Sliding, step: &mut Step<'_>) {
        if self.is_told {
            return;
        }
        if sliding.load <= 0.0 {
            *self = Self::default();
            return;
        }
        self.load += (sliding.load - self.load) / AVERAGE;
        self.slides += (sliding.slides - self.slides) / AVERAGE;
        let is_sliding = self.slides > SLIDES * self.load;
        let stuck = if is_sliding { sliding.caught / sliding.load } else { 0.0 };
        self.times = (self.times + stuck - RATE).max(0.0);
        if self.times < TIMES {
            return;
        }
        self.is_told = true;
        let [first, second] = bodies.map(|body| &step.world.body(body).name);
        // The points of each of two rigid bodies on the other are two contacts.
        let [begin, turned] =
            [(first, second), (second, first)].map(|(a, b)| format!("bodies `{a}` and `{b}` chatter:"));
        let is_of_both = |told: &String| told.starts_with(&begin) || told.starts_with(&turned);
        if !step.warnings.iter().any(is_of_both) {
            let damps = match bodies.map(|body| is_rigid(step, body)) {
                [true, true] => "a `restitution` below 1 damps them",
                _ => "`artificial_viscosity()` in the plugins of deformable bodies damps them",
            };
            step.warnings.push(format!(
                "{begin} until {} points that slide have stuck again {TIMES} times, because friction drives vibrations that nothing damps, and it falls short of its coefficient; {damps}",
                quantity(step.clock.end(), "s")
            ));
        }
    }
}
