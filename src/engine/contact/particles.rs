//! Contact between particles: discs or spheres of half a spacing, of two bodies or of one with itself.

use glam::DVec3;

use super::images::Mirror;
use super::law::Touch;
use super::memory::{Memories, PairKey};
use super::response::{Interaction, Losses, Meeting};
use super::search::{Crowd, Search};
use super::stiffness::NodeStiffness;
use super::tally::Tally;
use crate::neighbors::{NeighborError, Periodic};
use crate::plugin::BodyPlan;
use crate::scene::Dimension;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, Force, Mobility, Position, ReferencePosition, Removed, Velocity};

/// Particles of one body closer than this in the reference configuration do not touch, over the distance at which they
/// would: bonds hold them apart.
const APART: f64 = 2.5;

/// Contact between the particles of two bodies.
pub(super) struct ParticleContact {
    interaction: Interaction,
    pub first: BodyId,
    pub second: BodyId,
    /// Radius of every particle of both bodies, m.
    radius: [Vec<f64>; 2],
    /// The image of the second body that the first one touches.
    mirror: Mirror,
    periodic: Periodic,
    search: Search,
    pub memories: Memories,
    stiffness: [NodeStiffness; 2],
    /// Forces on the first particle of every pair that touches now.
    forces: Vec<(PairKey, DVec3)>,
    /// Least distance of two particles that just touch, m.
    least: f64,
}

/// Radius of a particle, m: half the side of the square or cube of its volume.
pub(super) fn radii(body: &BodyPlan, dimension: Dimension) -> Vec<f64> {
    let root = |volume: f64| if dimension == Dimension::Two { volume.sqrt() } else { volume.cbrt() };
    body.sites.iter().map(|site| 0.5 * root(site.volume)).collect()
}

impl ParticleContact {
    /// Contact between a body and an image of another, or of itself.
    pub fn new(
        interaction: Interaction,
        (first, second): (&BodyPlan, &BodyPlan),
        mirror: Mirror,
        periodic: Periodic,
        dimension: Dimension,
    ) -> Self {
        let radius = [radii(first, dimension), radii(second, dimension)];
        let least = radius.iter().map(|radius| radius.iter().copied().fold(f64::INFINITY, f64::min)).sum();
        let stiffness = [&radius[0], &radius[1]].map(|radius| NodeStiffness::new(radius.len()));
        Self {
            interaction,
            first: first.id,
            second: second.id,
            search: Search::new(&radius[0], &radius[1], periodic),
            radius,
            mirror,
            periodic,
            memories: Memories::default(),
            stiffness,
            forces: Vec::new(),
            least,
        }
    }

    /// Least period of the domain with which the contact works, m.
    pub fn least_period(&self) -> f64 {
        self.search.least_period()
    }

    fn find(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        let ((first, first_rows), (second, second_rows)) =
            (step.world.body_view(self.first), step.world.body_view(self.second));
        let (x, y) = (first.read::<Position>()?, second.read::<Position>()?);
        let own = Crowd { position: &x[first_rows.clone()], radius: &self.radius[0], mirror: Mirror::NONE };
        let other = Crowd { position: &y[second_rows], radius: &self.radius[1], mirror: self.mirror };
        let found = if self.first == self.second {
            let reference = first.read::<ReferencePosition>()?;
            let reference = &reference[first_rows];
            let (radius, mirror, periodic) = (&self.radius[0], self.mirror, self.periodic);
            self.search.of_itself(own, other, |i, j| {
                let (i, j) = (i as usize, j as usize);
                let x_ij = periodic.minimal_image(mirror.place(reference[j].0) - reference[i].0);
                x_ij.length() > APART * (radius[i] + radius[j])
            })
        } else {
            self.search.between(own, other)
        };
        found.map_err(|error: NeighborError| StepError::System {
            system: super::CONTACT.to_owned(),
            message: error.to_string(),
        })
    }

    /// Adds the forces of all pairs that touch; `speeds` are the largest of each body, m/s.
    pub fn run(&mut self, step: &mut Step<'_>, speeds: [f64; 2]) -> Result<Tally, StepError> {
        let speed = speeds[0] + speeds[1];
        if self.search.moved(speed * step.clock.dt) {
            self.find(step)?;
        }
        let tally = self.evaluate(step)?;
        self.apply(step)?;
        self.propose(step, speed);
        Ok(tally)
    }

    fn evaluate(&mut self, step: &Step<'_>) -> Result<Tally, StepError> {
        let dt = step.clock.dt;
        let ((first, first_rows), (second, second_rows)) =
            (step.world.body_view(self.first), step.world.body_view(self.second));
        let (x, y) = (first.read::<Position>()?, second.read::<Position>()?);
        let (v, u) = (first.read::<Velocity>()?, second.read::<Velocity>()?);
        let (mobility, other) = (first.read::<Mobility>()?, second.read::<Mobility>()?);
        let gone = [first.read::<Removed>()?, second.read::<Removed>()?];
        let (a, b) = (first_rows.start, second_rows.start);
        let mirror = self.mirror;
        let slip = |key: PairKey| v[a + key.0 as usize].0 - mirror.turn(u[b + key.1 as usize].0);
        // Of a particle and its own image one half is in the half that is solved.
        let of_itself = self.first == self.second;
        let share = move |key: PairKey| if of_itself && key.0 == key.1 { 0.5 } else { 1.0 };
        let other_side = usize::from(self.first != self.second);
        let mut tally = Tally::default();
        let mut losses = Losses::default();
        self.forces.clear();
        for &key in self.search.pairs() {
            let (i, j) = (key.0 as usize, key.1 as usize);
            let x_ij = self.periodic.minimal_image(mirror.place(y[b + j].0) - x[a + i].0);
            let reach = self.radius[0][i] + self.radius[1][j];
            let squared = x_ij.length_squared();
            if squared >= reach * reach || squared == 0.0 {
                continue;
            }
            if gone[0][a + i] == Removed::YES || gone[1][b + j] == Removed::YES {
                continue;
            }
            while let Some((old, memory)) = self.memories.ended_before(Some(key)) {
                losses.add_share(share(old), &memory, &Default::default(), slip(old), dt);
            }
            let before = self.memories.of(key);
            let distance = squared.sqrt();
            let meeting = Meeting {
                touch: Touch {
                    overlap: reach - distance,
                    radius: self.radius[0][i] * self.radius[1][j] / reach,
                    length: reach,
                },
                normal: -x_ij / distance,
                velocity: slip(key),
            };
            let (m_i, m_j) = (mobility[a + i].0, other[b + j].0);
            let along = |mobility: DVec3, n: DVec3| n.dot(mobility * n);
            let inverse_mass = |n| along(m_i, n) + along(m_j, n);
            let response = self.interaction.respond(&meeting, inverse_mass, dt, &before);
            losses.add_share(share(key), &before, &response.memory, meeting.velocity, dt);
            tally.stored += share(key) * (response.spring.energy + response.memory.energy());
            self.stiffness[0].add(i, response.spring.stiffness * along(m_i, meeting.normal));
            self.stiffness[other_side].add(j, response.spring.stiffness * along(m_j, meeting.normal));
            self.memories.keep(key, response.memory);
            self.forces.push((key, share(key) * response.force));
        }
        while let Some((old, memory)) = self.memories.ended_before(None) {
            losses.add_share(share(old), &memory, &Default::default(), slip(old), dt);
        }
        self.memories.turn();
        tally.losses = losses;
        Ok(tally)
    }

    /// The forces on both sides, in the order of pairs: exactly opposite, mirrored where an image is touched.
    fn apply(&self, step: &Step<'_>) -> Result<(), StepError> {
        for (body, sign) in [(self.first, 1.0), (self.second, -1.0)] {
            let (view, rows) = step.world.body_view(body);
            let mut force = view.write::<Force>()?;
            for ((i, j), pair_force) in &self.forces {
                let (number, own) =
                    if sign > 0.0 { (i, *pair_force) } else { (j, self.mirror.turn(*pair_force)) };
                force[rows.start + *number as usize].0 += sign * own;
            }
        }
        Ok(())
    }

    fn propose(&mut self, step: &mut Step<'_>, speed: f64) {
        let other_side = usize::from(self.first != self.second);
        let stiffest = self.forces.iter().map(|((i, j), _)| {
            self.stiffness[0].of(*i as usize) + self.stiffness[other_side].of(*j as usize)
        });
        let stiffest = stiffest.fold(0.0, f64::max);
        self.stiffness.iter_mut().for_each(NodeStiffness::clear);
        super::stiffness::propose(step, (self.first, self.second), stiffest, speed, self.least);
    }
}
