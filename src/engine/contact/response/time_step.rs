//! The stable time step of contact.

use glam::DVec3;

use crate::contact::laws::{NormalForce, Touch};
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, Mass};

/// A third of the critical step of the contacts alone: bonds, which use 0.6 of theirs, and contacts together
/// are stable, and the energy error of the first and the last step of a contact, which grows with the square
/// of this, is small.
const FREQUENCY_FACTOR: f64 = 0.7;
/// Share of the distance of two particles that just touch by which they may approach in a step.
const SWEPT_FACTOR: f64 = 0.25;

/// Factor for a touch of skins that begins or ends, two fifths of the critical step of the contact of a skin
/// alone, which is 1.33 over the root of stiffness over the mass of a layer of particles: what a touch misses
/// at its ends is a share of `k (v dt)^2` of a spring that begins, and bodies that bounce then keep their
/// energy to a thousandth.
const OF_LANDING: f64 = 0.55;
/// Factor for skins that are pressed: together with bonds, which have used up 0.65 of theirs, nine tenths of
/// the critical step. What hardens as it is pressed is stiff where nothing begins.
const OF_PRESSED: f64 = 0.85;
/// Ways in a step over the depth at which the centre of a particle is at the surface (of rigid bodies, over
/// the deepest overlap), up to which the spring stays what it is within a step, and from which on it changes
/// so much that the step is that of a touch that begins.
const STEADY: [f64; 2] = [0.01, 0.04];

/// Steps of the present length within which skins that are apart may touch: from then on the step is that of
/// a touch. A step that is longer than the contact allows would put a point that touches for the first time
/// too deep, and make energy.
const AHEAD: f64 = 3.0;
/// How far that may be, over the spacing: nearer facets are candidates, whenever they were last found.
const FARTHEST: f64 = 0.5;
/// Overlap over the spacing whose stiffness is taken for an imminent contact: the stiffness of laws may begin
/// at zero.
const EXPECTED: f64 = 0.05;

/// Input of the stable step of contact of two skins.
pub(in crate::contact) struct OfSkins<'a> {
    pub law: &'a dyn NormalForce,
    /// The law at an overlap of zero, and the area for which it holds, m2 (m).
    pub touch: Touch,
    pub usual: f64,
    /// Largest stiffness over an area of points that touch, N/m3 (N/m2 in two dimensions).
    pub stiffest: f64,
    /// Gap of the nearest point that does not touch, m.
    pub gap: f64,
    /// Sum of the largest speeds, m/s, and length of the step, s.
    pub speed: f64,
    pub dt: f64,
    /// Whether the reference of all that deforms stays. A reference that follows wants the steps of a touch
    /// for as long as it lasts: where the edge of a tool squeezes particles to a quarter of their volume,
    /// they lose their order in longer ones.
    pub keeps_reference: bool,
}

impl OfSkins<'_> {
    /// The stiffness over an area that [`propose`] is to go by, N/m3 (N/m2).
    pub fn stiffness(&self) -> f64 {
        let of = |factor: f64| (FREQUENCY_FACTOR / factor).powi(2);
        (of(OF_LANDING) * self.landing()).max(of(self.factor()) * self.stiffest)
    }

    /// Squared frequency of a rigid body on areas that may soon touch it, 1/s2; `landing` is the sum of area,
    /// m2 (m), times inverse mass of the body, 1/kg. In the step of the skin alone a light body would rebound
    /// with more than it had.
    pub fn of_landing_tool(&self, landing: f64) -> f64 {
        let touch = Touch { overlap: EXPECTED * self.touch.length, ..self.touch };
        (FREQUENCY_FACTOR / OF_LANDING).powi(2) * self.law.at(&touch).stiffness / self.usual * landing
    }

    /// How near a skin is to a touch, m, within the steps that a touch is expected ahead.
    pub fn reach(speed: f64, dt: f64, spacing: f64) -> f64 {
        // Nothing is known yet of the length of the first step.
        if dt == 0.0 { f64::INFINITY } else { (AHEAD * speed * dt).min(FARTHEST * spacing) }
    }

    /// The stiffness of touches that begin or end, or may do so soon; zero if that takes longer.
    fn landing(&self) -> f64 {
        let is_near = self.gap.is_finite() && self.gap < Self::reach(self.speed, self.dt, self.touch.length);
        if self.stiffest > 0.0 || is_near && self.speed > 0.0 {
            let touch = Touch { overlap: EXPECTED * self.touch.length, ..self.touch };
            self.law.at(&touch).stiffness / self.usual
        } else {
            0.0
        }
    }

    /// The factor for compressed contacts.
    fn factor(&self) -> f64 {
        if !self.keeps_reference {
            return OF_LANDING;
        }
        let way = self.speed * self.dt / self.touch.depth;
        let fast =
            if self.dt > 0.0 { ((way - STEADY[0]) / (STEADY[1] - STEADY[0])).clamp(0.0, 1.0) } else { 1.0 };
        OF_PRESSED + fast * (OF_LANDING - OF_PRESSED)
    }
}

/// Share of the usual step while springs let go that were loaded at the start: a leapfrog that starts from
/// rest loses (omega dt)^2 / 4 of their energy for good, which is 8 % in usual steps and a thousandth in
/// these. The step grows again as any other that was short does.
const OF_LOADED: f64 = 0.11;
/// Overlap of one particle, over the distance at which particles just touch, whose energy counts as a load.
/// What touches at the start overlaps by round-off.
const LOADED: f64 = 1e-3;

/// Properties of a contact of two bodies for the stable step.
pub(in crate::contact) struct Touches {
    /// Largest squared frequency of a contact, 1/s2.
    pub squared: f64,
    /// Energy of the springs, J.
    pub stored: f64,
    /// Speed of approach, m/s.
    pub speed: f64,
    /// Distance at which particles just touch, m.
    pub reach: f64,
}

/// Proposes the limits of two bodies.
///
/// # Errors
/// A column is missing.
pub(in crate::contact) fn propose(
    step: &mut Step<'_>,
    pair: [BodyId; 2],
    touches: &Touches,
) -> Result<(), StepError> {
    let &Touches { squared, stored, speed, reach } = touches;
    let world = step.world;
    let names = || pair.map(|body| &world.body(body).name);
    if squared > 0.0 {
        // Before the first step a clock has no step.
        let is_loaded = step.clock.dt == 0.0 && {
            let (view, rows) = world.body_view(pair[0]);
            stored > 0.5 * view.read::<Mass>()?[rows.start].0 * squared * (LOADED * reach).powi(2)
        };
        let share = if is_loaded { OF_LOADED } else { 1.0 };
        let [one, other] = names();
        step.limits.propose(
            share * FREQUENCY_FACTOR / squared.sqrt(),
            format_args!("stiffness of contact of `{one}` and `{other}`"),
        );
    }
    if speed > 0.0 {
        let limit = SWEPT_FACTOR * reach / speed;
        // Of many bodies most do not matter.
        if step.limits.has_below(limit) {
            return Ok(());
        }
        let [one, other] = names();
        step.limits.propose(limit, format_args!("speed of approach of `{one}` and `{other}`"));
    }
    Ok(())
}

/// Step of the contacts of rigid bodies, over one over their frequency: some sixty steps an impact, for its
/// energy; and where bodies lie, slide or roll on each other and nothing begins or ends. Friction, the
/// corners of slender bodies and others on the far side make the frequency up to four times as large, so that
/// steps stay below that part of the critical one.
const IMPACT_FACTORS: [f64; 2] = [0.05, 0.3];

/// Frequency of all springs together over that of a slow swing of a body on them, such as rocking.
const SLOWER: f64 = 2.0;

/// Normal motion of points of a rigid body, or particles of a wall, near the surface of another one.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct NormalMotion {
    /// Largest overlap, m.
    deepest: f64,
    /// Largest speed, m/s, and acceleration, m/s2, of those that touch or may do so soon.
    speed: f64,
    acceleration: f64,
}

impl NormalMotion {
    /// Of a particle that forces move: nothing is known of how it lands.
    pub const UNKNOWN: Self = Self { deepest: 0.0, speed: f64::INFINITY, acceleration: 0.0 };

    /// Of one point that moves at `speed`, m/s, with this acceleration, m/s2, before a step of length `dt`,
    /// s.
    pub fn of(overlap: f64, speed: f64, acceleration: f64, dt: f64) -> Self {
        if overlap > 0.0 || -overlap < AHEAD * speed * dt {
            Self { deepest: overlap.max(0.0), speed, acceleration }
        } else {
            Self::default()
        }
    }

    /// The larger of both.
    pub fn add(&mut self, other: &Self) {
        self.deepest = self.deepest.max(other.deepest);
        self.speed = self.speed.max(other.speed);
        self.acceleration = self.acceleration.max(other.acceleration);
    }

    /// Step over one over the frequency. The speed that counts is that of a swing about the state of balance,
    /// whose speed and acceleration are never zero at once: steps that change within a swing would give it
    /// energy.
    fn factor(&self, frequency: f64, dt: f64) -> f64 {
        let [of_impact, at_rest] = IMPACT_FACTORS;
        if dt == 0.0 {
            // Nothing is known yet of the length of the first step.
            return of_impact;
        }
        let way = self.speed.hypot(SLOWER * self.acceleration / frequency) * dt;
        let share = if way == 0.0 { 0.0 } else { way / self.deepest };
        at_rest + ((share - STEADY[0]) / (STEADY[1] - STEADY[0])).clamp(0.0, 1.0) * (of_impact - at_rest)
    }
}

/// Proposes the limit of contacts of two rigid bodies of a squared frequency, 1/s2.
pub(in crate::contact) fn propose_rigid(
    step: &mut Step<'_>,
    pair: [BodyId; 2],
    squared: f64,
    landing: NormalMotion,
) {
    let limit = limit_of_rigid(squared, &landing, step.clock.dt);
    if limit.is_finite() {
        let world = step.world;
        let (one, other) = (&world.body(pair[0]).name, &world.body(pair[1]).name);
        step.limits.propose(limit, format_args!("contact of rigid `{one}` and `{other}`"));
    }
}

/// That limit after a step of length `dt`, s; infinite without a contact.
pub(in crate::contact) fn limit_of_rigid(squared: f64, landing: &NormalMotion, dt: f64) -> f64 {
    let frequency = squared.sqrt();
    if squared > 0.0 { landing.factor(frequency, dt) / frequency } else { f64::INFINITY }
}

/// Share of the spacing by which two rigid bodies that may touch may approach in a step, and of the gap
/// between them.
const APPROACH_FACTOR: [f64; 2] = [0.1, 0.25];

/// Proposes the limit of two bodies, one of which is rigid, that approach with a velocity, m/s, over a gap,
/// m.
pub(in crate::contact) fn propose_approach(
    step: &mut Step<'_>,
    pair: [BodyId; 2],
    velocity: DVec3,
    gap: f64,
) {
    let (one, other) = (step.world.body(pair[0]), step.world.body(pair[1]));
    let limit = limit_of_approach(one.spacing.min(other.spacing), gap, velocity.length());
    if limit.is_finite() {
        let (one, other) = (&one.name, &other.name);
        step.limits.propose(limit, format_args!("speed of approach of `{one}` and `{other}`"));
    }
}

/// The limit of two rigid bodies of that smaller spacing, m, that approach at `speed`, m/s, over a gap, m; s.
#[inline]
pub(in crate::contact) fn limit_of_approach(spacing: f64, gap: f64, speed: f64) -> f64 {
    let [of_spacing, of_gap] = APPROACH_FACTOR;
    if speed > 0.0 { (of_spacing * spacing + of_gap * gap) / speed } else { f64::INFINITY }
}

/// Whether the reference of a body stays.
pub(in crate::contact) fn keeps_reference(step: &Step<'_>, body: BodyId) -> bool {
    let solid = step.resources.solid(step.world.body(body).phase);
    solid.is_some_and(|solid| solid.keeps_reference())
}
