//! Contact between particles: discs or spheres of half a spacing, of two bodies or of one with itself.

use glam::DVec3;

use super::search::{Crowd, Search};
use crate::contact::active::{ActiveContacts, ContactNodes, End, Least, Pull};
use crate::contact::bodies::{MemberColumns, MotionBounds, Nearness, Particles, failed, of_pair};
use crate::contact::laws::Touch;
use crate::contact::response::{ContactEnergy, ContactState, History, Interaction, Losses, PairKey};
use crate::neighbors::Periodic;
use crate::parallel::{BlockSum, Largest, sum_over_blocks};
use crate::schedule::{Step, StepError};
use crate::solids::LocalMotion;
use crate::symmetry::Map;
use crate::world::{Position, ReferencePosition};

/// Particles of one body closer than this in the reference configuration do not touch, over the distance at which they
/// would: bonds hold them apart.
const APART: f64 = 2.5;

/// Candidates of every particle of a side for which there is room from the start.
const CANDIDATES: usize = 12;

/// Contact between the particles of two bodies.
pub(in crate::contact) struct ParticleContact {
    interaction: Interaction,
    pub first: Particles,
    pub second: Particles,
    /// The image of the second body that the first one touches.
    mirror: Map,
    periodic: Periodic,
    search: Search,
    pub contacts: ActiveContacts<Nearness, Push, Least>,
    /// The particles of both sides that touch; of a body with itself all are on the first side.
    pub contact_nodes: [ContactNodes; 2],
}

/// Force on the first particle of a pair, N, where it acts on both, in the reference configuration, m, and the stiffness of the spring over
/// the mass of either side, 1/s2.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct Push {
    arms: [DVec3; 2],
    force: DVec3,
    stiffness: [f64; 2],
    /// Heat of friction in the step, J.
    heat: f64,
}

impl ParticleContact {
    /// Contact between a body and an image of another, or of itself.
    pub fn new(
        interaction: Interaction,
        [first, second]: [Particles; 2],
        mirror: Map,
        periodic: Periodic,
    ) -> Self {
        let room = CANDIDATES * first.on_a_side.min(second.on_a_side);
        let mut contact_nodes = [&first, &second].map(|particles| ContactNodes::new(particles.radius.len()));
        contact_nodes.iter_mut().for_each(|contact_nodes| contact_nodes.reserve(room));
        let mut contacts = ActiveContacts::default();
        contacts.reserve(room);
        let search = Search::new(&first.radius, &second.radius, periodic, room);
        Self { interaction, search, first, second, mirror, periodic, contacts, contact_nodes }
    }

    /// Least period of the domain with which the contact works, m.
    pub fn least_period(&self) -> f64 {
        self.search.least_period()
    }

    fn find(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        let ((first, first_rows), (second, second_rows)) =
            (step.world.body_view(self.first.body), step.world.body_view(self.second.body));
        let (x, y) = (first.read::<Position>()?, second.read::<Position>()?);
        let own =
            Crowd { position: &x[first_rows.clone()], radius: &self.first.radius, mirror: Map::IDENTITY };
        let other = Crowd { position: &y[second_rows], radius: &self.second.radius, mirror: self.mirror };
        let found = if self.first.body == self.second.body {
            let reference = first.read::<ReferencePosition>()?;
            let reference = &reference[first_rows];
            let (radius, mirror, periodic) = (&self.first.radius, self.mirror, self.periodic);
            self.search.of_itself(own, other, |i, j| {
                let (i, j) = (i as usize, j as usize);
                let x_ij = periodic.minimal_image(mirror.place(reference[j].0) - reference[i].0);
                x_ij.length() > APART * (radius[i] + radius[j])
            })
        } else {
            self.search.between(own, other)
        };
        found.map_err(failed)
    }

    /// Works out the forces of all pairs that touch.
    pub fn run(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<ContactEnergy, StepError> {
        let speed = motion[0].speed + motion[1].speed;
        let stretch = motion[0].stretch.max(motion[1].stretch);
        if self.search.moved(speed * step.clock.dt, stretch) {
            self.find(step)?;
            let pairs = self.search.pairs();
            let of_itself = self.first.body == self.second.body;
            let ends = if of_itself { &[End::First, End::Second][..] } else { &[End::First] };
            self.contact_nodes[0].renew(pairs, ends);
            if !of_itself {
                self.contact_nodes[1].renew(pairs, &[End::Second]);
            }
        }
        let (energies, least) = self.evaluate(step, stretch)?;
        self.propose(step, speed, least);
        Ok(energies)
    }

    /// The force of every pair that touches; returns the energies, and the least distance of two that are near and just touch, m.
    fn evaluate(&mut self, step: &Step<'_>, stretch: f64) -> Result<(ContactEnergy, f64), StepError> {
        let Self { interaction, contacts, contact_nodes, mirror, periodic, search, .. } = self;
        let dt = step.clock.dt;
        let first = MemberColumns::new(&self.first, step.world, step.resources)?;
        let second = MemberColumns::new(&self.second, step.world, step.resources)?;
        let (first, second) = (first.members(), second.members());
        let of_itself = self.first.body == self.second.body;
        let least = contacts.find(search.pairs(), |key, least: &mut Least| {
            let (i, j) = (key.0 as usize, key.1 as usize);
            let x_ij = periodic.minimal_image(mirror.place(second.position(j)) - first.position(i));
            let reach = first.radius(i) + second.radius(j);
            let (squared, farthest) = (x_ij.length_squared(), reach * stretch);
            if squared >= farthest * farthest || squared == 0.0 {
                return None;
            }
            let (radius, f) = second.shape(j);
            let near = of_pair(x_ij, first.shape(i), (radius, f.map(|f| mirror.tensor(f))));
            least.add(&Least(reach / near.scale));
            // What is not a number does not touch.
            let touches = near.overlap > 0.0 && first.is_there(i) && second.is_there(j);
            (touches && !(of_itself && first.holds_together(i, j))).then_some(near)
        });
        let other = usize::from(!of_itself);
        let moving = !interaction.is_elastic();
        contact_nodes[0].look(&first, contacts.numbers(), moving);
        contact_nodes[1].look(&second, contacts.numbers(), moving);
        let velocity = |of: [&LocalMotion; 2], arms: [DVec3; 2]| {
            of[0].velocity(arms[0]) - mirror.vector(of[1].velocity(mirror.vector(arms[1])))
        };
        // Of a particle and its own image one half is in the half that is solved.
        let share = move |key: PairKey| if of_itself && key.0 == key.1 { 0.5 } else { 1.0 };
        let respond = |key: PairKey, near: &Nearness, before: &History, energies: &mut ContactEnergy| {
            let (i, j) = (key.0 as usize, key.1 as usize);
            // What is new may need the velocity where the others do not.
            let new = (before.is_none() && !moving)
                .then(|| [first.local_motion(i, true), second.local_motion(j, true)]);
            let of = match &new {
                Some([first, second]) => [first, second],
                None => [contact_nodes[0].local_motion(key.0), contact_nodes[other].local_motion(key.1)],
            };
            let share = share(key);
            // The forces of the last step on the motion of this one.
            let mut losses = Losses::default();
            if !before.is_elastic() {
                losses.add_work(share, before, velocity(of, before.arms), dt);
            }
            let reach = first.radius(i) + second.radius(j);
            let radius = first.radius(i) * second.radius(j) / reach;
            let mobility = [of[0].mobility(near.arms[0]), of[1].mobility(mirror.vector(near.arms[1]))];
            let state = ContactState {
                touch: Touch { overlap: near.overlap, radius, length: reach, depth: reach },
                normal: near.normal,
                scale: near.scale,
                area: 1.0,
                arms: near.arms,
                velocity: velocity(of, near.arms),
            };
            let inverse_mass = |n: DVec3| (mobility[0] + mobility[1]).dot(n * n);
            let response = interaction.respond(&state, inverse_mass, dt, before);
            losses.add_work(share, &response.history, state.velocity, dt);
            losses.keep(share, before, &response.history);
            energies.losses.add(&losses);
            energies.stored += share * (response.spring.energy + response.history.energy());
            let across = near.normal * near.normal;
            let stiffness = mobility.map(|mobility| response.spring.stiffness * mobility.dot(across));
            (
                response.history,
                Push { arms: near.arms, force: share * response.force, stiffness, heat: losses.friction },
            )
        };
        let end = |key: PairKey, history: &History, energies: &mut ContactEnergy| {
            if !history.is_elastic() {
                let of =
                    [first.local_motion(key.0 as usize, true), second.local_motion(key.1 as usize, true)];
                energies.losses.add_work(share(key), history, velocity([&of[0], &of[1]], history.arms), dt);
            }
            energies.losses.keep(share(key), history, &History::default());
            let (i, j) = (key.0 as usize, key.1 as usize);
            if !first.is_there(i) || !second.is_there(j) {
                let x_ij = periodic.minimal_image(mirror.place(second.position(j)) - first.position(i));
                let reach = first.radius(i) + second.radius(j);
                let radius = first.radius(i) * second.radius(j) / reach;
                let of = [first.local_motion(i, true), second.local_motion(j, true)];
                let state = ContactState {
                    touch: Touch { overlap: history.overlap, radius, length: reach, depth: reach },
                    normal: -x_ij.normalize_or_zero(),
                    scale: 1.0,
                    area: 1.0,
                    arms: history.arms,
                    velocity: velocity([&of[0], &of[1]], history.arms),
                };
                energies.removed += share(key) * interaction.held(&state, dt, history);
            }
        };
        let energies = contacts.respond(respond, end);
        let pushes = contacts.pushes();
        let pull = |number: usize, end: End| {
            let Push { arms, force, stiffness, heat } = pushes[number];
            let (force, arm, side) = match end {
                End::First => (force, arms[0], 0),
                End::Second => (-mirror.vector(force), mirror.vector(arms[1]), 1),
            };
            let (stiffness, heat) = (stiffness[side], interaction.heat[side] * heat);
            Pull { force, arm, stiffness, beside: DVec3::ZERO, heat }
        };
        contact_nodes.iter_mut().for_each(|contact_nodes| contact_nodes.add_up(contacts.numbers(), &pull));
        Ok((energies, least.0.min(self.first.least() + self.second.least())))
    }

    fn propose(&self, step: &mut Step<'_>, speed: f64, least: f64) {
        let [one, other] = &self.contact_nodes;
        let other = if self.first.body == self.second.body { one } else { other };
        let stiffest = sum_over_blocks(self.contacts.met(), &|_, met: &[(PairKey, Nearness)]| {
            Largest::of(met.iter().map(|((i, j), _)| one.stiffness(*i) + other.stiffness(*j)))
        });
        let bodies = (self.first.body, self.second.body);
        crate::contact::response::time_step::propose(step, bodies, stiffest.0, speed, least);
    }
}
