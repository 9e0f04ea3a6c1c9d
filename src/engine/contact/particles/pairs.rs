//! Pairs of particles in a step: which of them touch, and their forces.

use glam::{DMat3, DVec3};

use crate::contact::active::{ContactEnd, ContactNodes, MinimumLength, NodeLoad};
use crate::contact::bodies::{Members, ParticleShape, Proximity, of_pair};
use crate::contact::laws::Touch;
use crate::contact::response::{ContactEnergy, ContactState, History, Interaction, Losses, PairKey, spin_of};
use crate::neighbors::Periodic;
use crate::solids::LocalMotion;
use crate::symmetry::Map;

/// Force on the first particle of a pair, N, where it acts on both, in the reference configuration, m, and
/// the stiffness of the spring over the mass of either side, 1/s2.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct PairPush {
    arms: [DVec3; 2],
    force: DVec3,
    stiffness: [f64; 2],
    /// Heat of friction in the step, J.
    heat: f64,
}

/// The particles of both sides in a step, and how they act on each other.
pub(super) struct ContactPairs<'a> {
    pub interaction: &'a Interaction,
    pub first: Members<'a>,
    pub second: Members<'a>,
    /// The image of the second body that the first one touches.
    pub mirror: Map,
    pub periodic: Periodic,
    /// Whether both sides are one body.
    pub of_itself: bool,
    /// Bound of the stretches of all particles.
    pub stretch: f64,
    /// Length of the step, s.
    pub dt: f64,
}

impl ContactPairs<'_> {
    /// Overlap of two particles in contact. Takes in the distance of those that are near and just touch, m.
    #[inline(always)]
    pub fn touching(&self, key: PairKey, least: &mut MinimumLength) -> Option<Proximity> {
        let Self { first, second, mirror, .. } = self;
        let (i, j) = (key.0 as usize, key.1 as usize);
        let x_ij = self.x_ij(i, j);
        let reach = first.radius(i) + second.radius(j);
        let (squared, farthest) = (x_ij.length_squared(), reach * self.stretch);
        if squared >= farthest * farthest || squared == 0.0 {
            return None;
        }
        let other = second.shape(j);
        let other = ParticleShape { gradient: other.gradient.map(|f| mirror.tensor(f)), ..other };
        let near = of_pair(x_ij, first.shape(i), other);
        least.add_length(reach / near.scale);
        // What is not a number does not touch.
        let touches = near.overlap > 0.0 && first.is_there(i) && second.is_there(j);
        (touches && !(self.of_itself && first.holds_together(i, j))).then_some(near)
    }

    /// The force of a pair that touches, with its history; `nodes` are the particles of both sides.
    #[inline(always)]
    pub fn respond(
        &self,
        key: PairKey,
        near: &Proximity,
        before: &History,
        nodes: [&ContactNodes; 2],
        energies: &mut ContactEnergy,
    ) -> (History, PairPush) {
        let Self { interaction, first, second, mirror, dt, .. } = self;
        let (i, j) = (key.0 as usize, key.1 as usize);
        // What is new may need the velocity where the others do not.
        let new = (before.is_none() && interaction.is_elastic())
            .then(|| [first.local_motion(i, true), second.local_motion(j, true)]);
        let of = match &new {
            Some([first, second]) => [first, second],
            None => [nodes[0].local_motion(key.0), nodes[1].local_motion(key.1)],
        };
        let share = self.share(key);
        // The forces of the last step on the motion of this one.
        let mut losses = Losses::default();
        if !before.is_elastic() {
            losses.add_work(share, before, self.velocity(of, before.arms), *dt);
        }
        let mobility = [of[0].mobility(near.arms[0]), of[1].mobility(mirror.vector(near.arms[1]))];
        let state = ContactState {
            touch: self.touch(i, j, near.overlap),
            normal: near.normal,
            scale: near.scale,
            area: 1.0,
            arms: near.arms,
            velocity: self.velocity(of, near.arms),
            lag: DVec3::ZERO,
            spin: self.spin(of, key).dot(near.normal),
            acceleration: DVec3::ZERO,
        };
        let inverse_mass = |n: DVec3| (mobility[0] + mobility[1]).dot(n * n);
        let response = interaction.respond(&state, inverse_mass, *dt, before);
        losses.add_work(share, &response.history, state.velocity, *dt);
        losses.keep(share, before, &response.history);
        energies.losses.add(&losses);
        energies.stored += share * (response.spring.energy + response.history.energy());
        energies.ahead += 0.5 * dt * share * response.force.dot(state.velocity);
        let across = near.normal * near.normal;
        let stiffness = mobility.map(|mobility| response.spring.stiffness * mobility.dot(across));
        let force = share * response.force;
        (response.history, PairPush { arms: near.arms, force, stiffness, heat: losses.friction })
    }

    /// Takes in the energy of a pair that has parted or lost a particle.
    pub fn end(&self, key: PairKey, history: &History, energies: &mut ContactEnergy) {
        let (i, j) = (key.0 as usize, key.1 as usize);
        let share = self.share(key);
        let velocity = || {
            let of = [self.first.local_motion(i, true), self.second.local_motion(j, true)];
            self.velocity([&of[0], &of[1]], history.arms)
        };
        if !history.is_elastic() {
            energies.losses.add_work(share, history, velocity(), self.dt);
        }
        energies.losses.keep(share, history, &History::default());
        if !self.first.is_there(i) || !self.second.is_there(j) {
            let state = ContactState {
                touch: self.touch(i, j, history.overlap),
                normal: -self.x_ij(i, j).normalize_or_zero(),
                scale: 1.0,
                area: 1.0,
                arms: history.arms,
                velocity: velocity(),
                lag: DVec3::ZERO,
                spin: 0.0,
                acceleration: DVec3::ZERO,
            };
            energies.removed += share * self.interaction.held(&state, self.dt, history);
        }
    }

    /// Force of a pair on its particle at that end.
    #[inline(always)]
    pub fn load(&self, push: &PairPush, end: ContactEnd) -> NodeLoad {
        let PairPush { arms, force, stiffness, heat } = *push;
        let (force, arm, side) = match end {
            ContactEnd::First => (force, arms[0], 0),
            ContactEnd::Second => (-self.mirror.vector(force), self.mirror.vector(arms[1]), 1),
        };
        let (stiffness, heat) = (stiffness[side], self.interaction.heat[side] * heat);
        NodeLoad { force, arm, stiffness, beside: DVec3::ZERO, heat }
    }

    /// From the first particle to the second, m.
    #[inline(always)]
    fn x_ij(&self, i: usize, j: usize) -> DVec3 {
        let place = self.mirror.place(self.second.position(j));
        self.periodic.minimal_image(place - self.first.position(i))
    }

    #[inline(always)]
    fn touch(&self, i: usize, j: usize, overlap: f64) -> Touch {
        let (first, second) = (self.first.radius(i), self.second.radius(j));
        let reach = first + second;
        Touch { overlap, radius: first * second / reach, length: reach, depth: reach }
    }

    /// Velocity of the first side relative to the second at points beside the particles, m/s.
    #[inline(always)]
    fn velocity(&self, of: [&LocalMotion; 2], arms: [DVec3; 2]) -> DVec3 {
        of[0].velocity(arms[0]) - self.mirror.vector(of[1].velocity(self.mirror.vector(arms[1])))
    }

    /// Angular velocity of the material around both particles, 1/s: the mean of both. Spheres have none, and
    /// without friction it does not count.
    #[inline(always)]
    fn spin(&self, of: [&LocalMotion; 2], key: PairKey) -> DVec3 {
        if self.interaction.friction == 0.0 {
            return DVec3::ZERO;
        }
        let around = |motion: &LocalMotion, shape: ParticleShape| {
            shape.gradient.map_or(DMat3::ZERO, |gradient| motion.rate * gradient.inverse())
        };
        let first = around(of[0], self.first.shape(key.0 as usize));
        let second = around(of[1], self.second.shape(key.1 as usize));
        0.5 * spin_of(first + self.mirror.tensor(second))
    }

    /// Of a particle and its own image one half is in the half that is solved.
    fn share(&self, key: PairKey) -> f64 {
        if self.of_itself && key.0 == key.1 { 0.5 } else { 1.0 }
    }
}
