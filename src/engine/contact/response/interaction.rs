//! The force of one contact: spring and dashpot along the normal; spring, dashpot and Coulomb's limit in the
//! tangential direction.
//!
//! Velocities are those of mid-step. The dashpots act on the velocity that results from the contact itself at
//! the end of the step, `u = (u' - dt/2 w f)/(1 + dt/2 w c)` with the inverse mass w. They damp at any time
//! step, and the restitution does not depend on the step to first order. Other forces act there too: the
//! bonds of a particle balance the contact force f of the last step, and weight and other contacts act on a
//! rigid body, whose acceleration a of the last step includes f. So only the change of f counts, in addition
//! to a: `u = (u' + dt/2 (a - w (f - f_last)))/(1 + dt/2 w c)`. Otherwise a dashpot would act on compressed
//! bodies at rest, its dissipation would be negative, and stacks would receive an impulse whenever the step
//! changes.

use glam::DVec3;

use super::history::History;
use super::sliding::Sliding;
use super::spin::turned_about;
use crate::contact::laws::{NormalForce, Spring, Touch};

/// Interaction of two bodies in contact.
pub(in crate::contact) struct Interaction {
    pub law: Box<dyn NormalForce>,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Damping ratio of an impact.
    pub damping_ratio: f64,
    /// Tangential over normal stiffness (Mindlin): 2 (1 - nu)/(2 - nu).
    pub tangential: f64,
    /// Shares of the sides in the heat of friction.
    pub heat: [f64; 2],
}

/// Current state of a contact.
#[derive(Clone, Copy)]
pub(in crate::contact) struct ContactState {
    pub touch: Touch,
    /// Unit vector from the second side to the first.
    pub normal: DVec3,
    /// d(overlap)/d(normal approach).
    pub scale: f64,
    /// Area of the contact over that for which the law holds.
    pub area: f64,
    /// From the particles of both sides to the point of contact, in the reference configuration, m.
    pub arms: [DVec3; 2],
    /// Velocity of the first side relative to the second at that point at mid-step, m/s.
    pub velocity: DVec3,
    /// Mean of this velocity in the step less `velocity`, m/s, where rigid bodies turn: a spring that follows
    /// `velocity` would creep by `omega dt / 2` of the way along a circle.
    pub lag: DVec3,
    /// Angular velocity of the sides about the normal at mid-step, 1/s: sides that stick turn the tangential
    /// spring with them.
    pub spin: f64,
    /// Acceleration there of the first side relative to the second by all forces of the last step, m/s2: of
    /// rigid bodies; the forces on particles are taken to be in equilibrium.
    pub acceleration: DVec3,
}

/// Force and stiffness of a contact.
pub(in crate::contact) struct Response {
    /// Force on the first side, N.
    pub force: DVec3,
    pub spring: Spring,
    pub history: History,
}

/// Dissipation of contacts in a step, J, and which of them slide.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::contact) struct Losses {
    pub damping: f64,
    pub friction: f64,
    /// The normal forces of those that slide.
    pub sliding: Sliding,
}

/// Limits of the tangential force of a contact.
#[derive(Clone, Copy)]
struct Limits {
    /// Stiffness of the tangential spring, N/m.
    stiffness: f64,
    /// Coulomb's limit, N.
    force: f64,
}

/// Forces of the tangential spring and dashpot on the first side, N.
#[derive(Default)]
struct Tangential {
    spring: DVec3,
    drag: DVec3,
    /// Whether they are at Coulomb's limit.
    slides: bool,
}

impl Interaction {
    /// Whether the force depends on the overlap only.
    pub fn is_elastic(&self) -> bool {
        self.friction == 0.0 && self.damping_ratio == 0.0
    }

    /// The force; `inverse_mass` is that of both sides together along a direction, 1/kg.
    pub fn respond(
        &self,
        state: &ContactState,
        inverse_mass: impl Fn(DVec3) -> f64,
        dt: f64,
        before: &History,
    ) -> Response {
        let ContactState { touch, normal, velocity, scale, area, .. } = *state;
        let touch = Touch { overlap: (touch.overlap - before.offset).max(0.0), ..touch };
        let mut spring = self.law.at(&touch).along(scale).scaled(area);
        let approach = -velocity.dot(normal);
        spring.force *= share_of_step(&touch, scale * approach * dt, before);
        self.beside(spring, &ContactState { touch, ..*state }, inverse_mass, dt, before)
    }

    /// The spring, of an area over that for which the law holds, where nothing but the overlap counts; the
    /// sides have come closer by `way`, m, in the step.
    #[inline]
    pub fn elastic(&self, touch: &Touch, area: f64, way: f64, before: &History) -> (Spring, History) {
        let touch = Touch { overlap: (touch.overlap - before.offset).max(0.0), ..*touch };
        let mut spring = self.law.at(&touch).scaled(area);
        spring.force = (spring.force * share_of_step(&touch, way, before)).max(0.0);
        let stiffness = self.tangential * spring.stiffness;
        let (overlap, offset, pressure) = (touch.overlap, before.offset, spring.force);
        (spring, History { stiffness, overlap, offset, pressure, ..History::default() })
    }

    /// Energy at the end of the last step of a contact that ends because a particle is removed, and the work
    /// of its force in the last kick, J; the relative velocity of the sides is given, m/s.
    pub fn held(&self, state: &ContactState, dt: f64, before: &History) -> f64 {
        let touch = Touch { overlap: before.overlap, ..state.touch };
        let force = before.pressure - before.dashpot.dot(state.normal);
        self.law.at(&touch).energy - 0.5 * dt * force * state.normal.dot(state.velocity)
    }

    /// The spring of a point of a surface without history, for an area over that for which the law holds: its
    /// overlaps in the last and in the next step follow from its speed of approach, m/s.
    #[inline]
    pub fn spring(&self, touch: &Touch, area: f64, approach: f64, dt: f64) -> Spring {
        let mut spring = self.law.at(touch).scaled(area);
        let way = approach.abs() * dt;
        spring.force *= share_of_way(touch, way);
        spring
    }

    /// The force of a spring with dashpot and friction.
    pub fn beside(
        &self,
        spring: Spring,
        state: &ContactState,
        inverse_mass: impl Fn(DVec3) -> f64,
        dt: f64,
        before: &History,
    ) -> Response {
        let ContactState { touch, normal, velocity, acceleration, scale, arms, .. } = state;
        // Without a dashpot masses are not needed.
        let inverse_mass = |n: DVec3| if self.damping_ratio == 0.0 { 0.0 } else { inverse_mass(n) };
        let across = inverse_mass(*normal);
        let approach = -velocity.dot(*normal);
        let begun = self.share_of_first_step(touch, scale * approach, dt, before);
        let (late, change) =
            (approach - 0.5 * dt * acceleration.dot(*normal), spring.force - before.pressure);
        let damping = begun * self.dashpot(spring.stiffness, across, late, change, dt);
        let pressure = (spring.force + damping).max(0.0);
        let stiffness = self.tangential * spring.stiffness;
        let limits = Limits { stiffness, force: self.friction * pressure };
        let Tangential { spring: tangential, drag, slides } =
            self.tangential(state, limits, &inverse_mass, dt, before);
        let dashpot = (pressure - spring.force) * *normal + drag;
        let (overlap, arms) = (touch.overlap, *arms);
        Response {
            force: pressure * *normal + tangential + drag,
            spring,
            history: History {
                spring: tangential,
                stiffness,
                dashpot,
                overlap,
                offset: before.offset,
                arms,
                pressure,
                slides,
            },
        }
    }

    /// A dashpot whose force jumps at first contact has acted since then, and not since half a step before:
    /// the share of a step for which it acts in the kicks around the end of its first one.
    fn share_of_first_step(&self, touch: &Touch, approach: f64, dt: f64, before: &History) -> f64 {
        if before.is_none()
            && approach * dt > 0.0
            && self.law.at(&Touch { overlap: 0.0, ..*touch }).stiffness > 0.0
        {
            0.5 + (touch.overlap / (approach * dt)).min(1.0)
        } else {
            1.0
        }
    }

    /// Force of a dashpot beside a spring of that stiffness that slows a motion at `speed`, N; `force` is the
    /// force of the spring.
    fn dashpot(&self, stiffness: f64, inverse_mass: f64, speed: f64, force: f64, dt: f64) -> f64 {
        if self.damping_ratio == 0.0 || inverse_mass <= 0.0 {
            return 0.0;
        }
        let c = 2.0 * self.damping_ratio * self.law.damping_factor() * (stiffness / inverse_mass).sqrt();
        let half = 0.5 * dt * inverse_mass;
        c * (speed - half * force) / (1.0 + half * c)
    }

    fn tangential(
        &self,
        state: &ContactState,
        Limits { stiffness, force: limit }: Limits,
        inverse_mass: &impl Fn(DVec3) -> f64,
        dt: f64,
        before: &History,
    ) -> Tangential {
        if self.friction == 0.0 {
            return Tangential::default();
        }
        let ContactState { normal, velocity, lag, acceleration, spin, .. } = state;
        let across = |of: &DVec3| of - of.dot(*normal) * normal;
        let slip = across(velocity);
        let mut spring = turned_about(*normal, spin * dt, before.spring);
        // A spring that gets softer keeps its stretch, one that gets stiffer its force: neither makes energy.
        if stiffness < before.stiffness {
            spring *= stiffness / before.stiffness;
        }
        spring -= stiffness * dt * (slip + across(lag));
        let held = spring.length();
        if held >= limit {
            let spring = if held > 0.0 { spring * (limit / held) } else { DVec3::ZERO };
            return Tangential { spring, drag: DVec3::ZERO, slides: true };
        }
        let along = slip.normalize_or(spring.normalize_or_zero());
        let drag_before = across(&before.dashpot);
        let taken_up = if is_held(&state.touch) { before.spring } else { before.spring + drag_before };
        let (late, pull) = ((slip + 0.5 * dt * acceleration).dot(along), (taken_up - spring).dot(along));
        let drag = -self.dashpot(stiffness, inverse_mass(along), late, pull, dt) * along;
        let remaining = limit - held;
        let drag = if drag.length() > remaining { drag * (remaining / drag.length()) } else { drag };
        Tangential { spring, drag, slides: false }
    }
}

/// Whether a side has bonds: rigid bodies have none.
fn is_held(touch: &Touch) -> bool {
    touch.depth.is_finite()
}

/// The force of a spring acts in the kicks around the end of a step, half a step each. In its first step a
/// contact has acted since first contact, with half of that force on average; in its last it acts until
/// separation. Without this share the energy of a contact would have an error of up to an eighth of `k (v
/// dt)^2` at its beginning and at its end. Rigid bodies take steps so short that it does not matter, and gain
/// no energy by this estimate.
fn share_of_step(touch: &Touch, approach: f64, before: &History) -> f64 {
    share_of_way(touch, if before.is_none() { approach } else { before.overlap - touch.overlap })
}

/// The same, for an overlap that began or ends within the displacement of a step, m.
#[inline]
fn share_of_way(touch: &Touch, way: f64) -> f64 {
    let overlap = touch.overlap;
    if way > overlap && is_held(touch) { 0.5 + 0.5 * overlap / way } else { 1.0 }
}

impl Losses {
    /// Adds those of another contact.
    pub fn add(&mut self, other: &Self) {
        self.damping += other.damping;
        self.friction += other.friction;
        self.sliding.add(&other.sliding);
    }

    /// Adds the work of the forces of a contact at one end of the step, with the velocity of the first side
    /// relative to the second, m/s: each of the two kicks applies half of the force.
    pub fn add_work(&mut self, share: f64, history: &History, velocity: DVec3, dt: f64) {
        let half = 0.5 * share * dt * velocity;
        self.damping -= history.dashpot.dot(half);
        self.friction -= history.spring.dot(half);
    }

    /// Adds that the tangential spring keeps a part of it, and whether the contact slides.
    pub fn keep(&mut self, share: f64, before: &History, now: &History) {
        self.sliding.take_in(share, before, now);
        self.friction -= share * (now.energy() - before.energy());
    }
}
