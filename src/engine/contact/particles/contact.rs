//! Contact between particles: discs or spheres of half a spacing, of two bodies or of one with itself.

use super::pairs::{ContactPairs, PairPush};
use super::search::{ContactParticles, Search};
use crate::contact::active::{ActiveContacts, ContactEnd, ContactNodes, MinimumLength};
use crate::contact::bodies::{APART, MemberColumns, MemberParticles, MotionBounds, Proximity, failed};
use crate::contact::response::time_step::{self, Touches};
use crate::contact::response::{ContactEnergy, History, Interaction, PairKey};
use crate::neighbors::Periodic;
use crate::parallel::{Maximum, sum_over_blocks};
use crate::schedule::{Step, StepError};
use crate::symmetry::Map;
use crate::world::{Position, ReferencePosition};

/// Candidates of every particle of a side with memory from the start.
const CANDIDATES: usize = 12;

/// Contact between the particles of two bodies.
pub(in crate::contact) struct ParticleContact {
    interaction: Interaction,
    pub first: MemberParticles,
    pub second: MemberParticles,
    /// The image of the second body that the first one touches.
    mirror: Map,
    periodic: Periodic,
    search: Search,
    pub contacts: ActiveContacts<Proximity, PairPush, MinimumLength>,
    /// The particles of both sides that touch; of a body with itself all are on the first side.
    pub contact_nodes: [ContactNodes; 2],
}

impl ParticleContact {
    /// Contact between a body and an image of another, or of itself.
    pub fn new(
        interaction: Interaction,
        [first, second]: [MemberParticles; 2],
        mirror: Map,
        periodic: Periodic,
    ) -> Self {
        let capacity = CANDIDATES * first.on_a_side.min(second.on_a_side);
        let mut contact_nodes = [&first, &second].map(|particles| ContactNodes::new(particles.radius.len()));
        contact_nodes.iter_mut().for_each(|contact_nodes| contact_nodes.reserve(capacity));
        let mut contacts = ActiveContacts::default();
        contacts.reserve(capacity);
        let search = Search::new(&first.radius, &second.radius, periodic, capacity);
        Self { interaction, search, first, second, mirror, periodic, contacts, contact_nodes }
    }

    /// Minimum period of the domain with which the contact works, m.
    pub fn min_period(&self) -> f64 {
        self.search.min_period()
    }

    /// Whether nothing touches and no particles are near each other; the boxes around both bodies tell
    /// nothing of their images.
    pub fn is_idle(&self) -> bool {
        let is_empty = self.search.pairs().is_empty() && self.contacts.histories.is_empty();
        is_empty && self.mirror == Map::IDENTITY
    }

    /// Has all pairs searched again.
    pub fn forget(&mut self) {
        self.search.forget();
    }

    fn find(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        let ((first, first_rows), (second, second_rows)) =
            (step.world.body_view(self.first.body), step.world.body_view(self.second.body));
        let (x, y) = (first.read_near::<Position>()?, second.read_near::<Position>()?);
        let own = ContactParticles {
            position: &x[first_rows.clone()],
            radius: &self.first.radius,
            mirror: Map::IDENTITY,
        };
        let other =
            ContactParticles { position: &y[second_rows], radius: &self.second.radius, mirror: self.mirror };
        let found = if self.first.body == self.second.body {
            let reference = first.read_near::<ReferencePosition>()?;
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

    /// Computes the forces of all pairs that touch.
    pub fn run(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<ContactEnergy, StepError> {
        let (speed, stretch) = self.update_candidates(step, motion)?;
        let (energies, least) = self.evaluate(step, stretch)?;
        let bodies = [self.first.body, self.second.body];
        let touches = Touches { squared: self.stiffest(), stored: energies.stored, speed, reach: least };
        time_step::propose(step, bodies, &touches)?;
        Ok(energies)
    }

    /// Energy of the springs of all active pairs, J.
    pub fn pressed(&mut self, step: &Step<'_>, motion: [MotionBounds; 2]) -> Result<f64, StepError> {
        let (_, stretch) = self.update_candidates(step, motion)?;
        Ok(self.evaluate(step, stretch)?.0.stored)
    }

    /// Has the pairs that touch begin with that part of their overlaps.
    pub fn begin(&mut self, part: f64) {
        self.contacts.begin(|_, near| History::begun(near.overlap, part));
    }

    /// Searches for pairs that may touch where they may be others; returns the speed of approach, m/s, and a
    /// bound of all stretches.
    fn update_candidates(
        &mut self,
        step: &Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<(f64, f64), StepError> {
        let speed = MotionBounds::approach(motion, &self.mirror);
        let stretch = motion[0].stretch.max(motion[1].stretch);
        if self.search.moved(speed * step.clock.dt, stretch) {
            self.find(step)?;
            let pairs = self.search.pairs();
            let of_itself = self.first.body == self.second.body;
            let ends =
                if of_itself { &[ContactEnd::First, ContactEnd::Second][..] } else { &[ContactEnd::First] };
            self.contact_nodes[0].renew(pairs, ends);
            if !of_itself {
                self.contact_nodes[1].renew(pairs, &[ContactEnd::Second]);
            }
        }
        Ok((speed, stretch))
    }

    /// The force of every pair that touches; returns the energies, and the minimum distance of two that are
    /// near and just touch, m.
    fn evaluate(&mut self, step: &Step<'_>, stretch: f64) -> Result<(ContactEnergy, f64), StepError> {
        let first = MemberColumns::new(&self.first, step.world, step.resources)?;
        let second = MemberColumns::new(&self.second, step.world, step.resources)?;
        let of_itself = self.first.body == self.second.body;
        let pairs = ContactPairs {
            interaction: &self.interaction,
            first: first.members(),
            second: second.members(),
            mirror: self.mirror,
            periodic: self.periodic,
            of_itself,
            stretch,
            dt: step.clock.dt,
        };
        let Self { contacts, contact_nodes, search, .. } = self;
        let least = contacts
            .find(search.pairs(), |key, least: &mut MinimumLength, (): &mut ()| pairs.touching(key, least));
        let moving = !pairs.interaction.is_elastic();
        contact_nodes[0].look(&pairs.first, contacts.numbers(), moving);
        contact_nodes[1].look(&pairs.second, contacts.numbers(), moving);
        let nodes = [&contact_nodes[0], &contact_nodes[usize::from(!of_itself)]];
        let energies = contacts.respond(
            pairs.first.len(),
            |key, near, before, energies| pairs.respond(key, near, before, nodes, energies),
            |key, history, energies| pairs.end(key, history, energies),
        );
        let pushes = contacts.pushes();
        let load = |number: usize, end: ContactEnd| pairs.load(&pushes[number], end);
        contact_nodes.iter_mut().for_each(|nodes| nodes.add_up(contacts.numbers(), &load));
        Ok((energies, least.0.min(self.first.min_radius() + self.second.min_radius())))
    }

    /// Largest squared frequency of a pair that touches, 1/s2.
    fn stiffest(&self) -> f64 {
        let [one, other] = &self.contact_nodes;
        let other = if self.first.body == self.second.body { one } else { other };
        let stiffest = sum_over_blocks(self.contacts.met(), &|_, met: &[(PairKey, Proximity)]| {
            Maximum::of(met.iter().map(|((i, j), _)| one.stiffness(*i) + other.stiffness(*j)))
        });
        stiffest.0
    }
}
