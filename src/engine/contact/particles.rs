//! Contact between particles: discs or spheres of half a spacing, of two bodies or of one with itself.

use glam::DVec3;

use super::images::Mirror;
use super::law::Touch;
use super::members::{Members, Particles};
use super::memory::{Memories, Memory, PairKey};
use super::response::{Interaction, Losses, Meeting};
use super::search::{Crowd, Search};
use super::shape::of_pair;
use super::stiffness::NodeStiffness;
use super::system::Pace;
use super::tally::Tally;
use crate::formulations::total_lagrangian::Families;
use crate::neighbors::{NeighborError, Periodic};
use crate::schedule::{Step, StepError};
use crate::world::{Force, Position, ReferencePosition};

/// Particles of one body closer than this in the reference configuration do not touch, over the distance at which they
/// would: bonds hold them apart.
const APART: f64 = 2.5;

/// Contact between the particles of two bodies.
pub(super) struct ParticleContact {
    interaction: Interaction,
    pub first: Particles,
    pub second: Particles,
    /// The image of the second body that the first one touches.
    mirror: Mirror,
    periodic: Periodic,
    search: Search,
    pub memories: Memories,
    stiffness: [NodeStiffness; 2],
    /// What the pairs that touch now do.
    forces: Vec<Push>,
    /// Least distance of two particles that just touch, m: of all in the reference configuration, and of those that are near now.
    least: f64,
    least_now: f64,
}

/// Force on the first particle of a pair, N, and from the particles to where it acts, in the reference configuration, m.
struct Push {
    pair: PairKey,
    arms: [DVec3; 2],
    force: DVec3,
}

impl ParticleContact {
    /// Contact between a body and an image of another, or of itself.
    pub fn new(
        interaction: Interaction,
        [first, second]: [Particles; 2],
        mirror: Mirror,
        periodic: Periodic,
    ) -> Self {
        let least = first.least() + second.least();
        let stiffness = [&first, &second].map(|particles| NodeStiffness::new(particles.radius.len()));
        Self {
            interaction,
            search: Search::new(&first.radius, &second.radius, periodic),
            first,
            second,
            mirror,
            periodic,
            memories: Memories::default(),
            stiffness,
            forces: Vec::new(),
            least,
            least_now: least,
        }
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
            Crowd { position: &x[first_rows.clone()], radius: &self.first.radius, mirror: Mirror::NONE };
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
        found.map_err(|error: NeighborError| StepError::System {
            system: super::CONTACT.to_owned(),
            message: error.to_string(),
        })
    }

    /// Adds the forces of all pairs that touch.
    pub fn run(&mut self, step: &mut Step<'_>, paces: [Pace; 2]) -> Result<Tally, StepError> {
        let speed = paces[0].speed + paces[1].speed;
        let stretch = paces[0].stretch.max(paces[1].stretch);
        if self.search.moved(speed * step.clock.dt, stretch) {
            self.find(step)?;
        }
        let tally = self.evaluate(step, stretch)?;
        self.apply(step)?;
        self.propose(step, speed);
        Ok(tally)
    }

    fn evaluate(&mut self, step: &Step<'_>, stretch: f64) -> Result<Tally, StepError> {
        let dt = step.clock.dt;
        let first = Members::new(&self.first, step.world, step.resources)?;
        let second = Members::new(&self.second, step.world, step.resources)?;
        let mirror = self.mirror;
        let slip = |(i, j): PairKey, arms: [DVec3; 2]| {
            first.velocity(i as usize, arms[0])
                - mirror.turn(second.velocity(j as usize, mirror.turn(arms[1])))
        };
        // Of a particle and its own image one half is in the half that is solved.
        let of_itself = self.first.body == self.second.body;
        let share = move |key: PairKey| if of_itself && key.0 == key.1 { 0.5 } else { 1.0 };
        let other_side = usize::from(!of_itself);
        let mut tally = Tally::default();
        let mut losses = Losses::default();
        // The forces of the last step on the motion of this one.
        let work_before = |losses: &mut Losses, key: PairKey, memory: &Memory| {
            if !memory.is_elastic() {
                losses.add_work(share(key), memory, slip(key, memory.arms), dt);
            }
        };
        let end = |losses: &mut Losses, key: PairKey, memory: &Memory| {
            work_before(losses, key, memory);
            losses.keep(share(key), memory, &Memory::default());
        };
        self.forces.clear();
        self.least_now = self.least;
        for &key in self.search.pairs() {
            let (i, j) = (key.0 as usize, key.1 as usize);
            let x_ij = self.periodic.minimal_image(mirror.place(second.position(j)) - first.position(i));
            let reach = first.radius(i) + second.radius(j);
            let (squared, farthest) = (x_ij.length_squared(), reach * stretch);
            if squared >= farthest * farthest || squared == 0.0 {
                continue;
            }
            let (radius, f) = second.shape(j);
            let near = of_pair(x_ij, first.shape(i), (radius, f.map(|f| mirror.map(f))));
            self.least_now = self.least_now.min(reach / near.scale);
            // What is not a number does not touch.
            if !(near.overlap > 0.0 && first.is_there(i) && second.is_there(j)) {
                continue;
            }
            while let Some((old, memory)) = self.memories.ended_before(Some(key)) {
                end(&mut losses, old, &memory);
            }
            let before = self.memories.of(key);
            work_before(&mut losses, key, &before);
            let radius = first.radius(i) * second.radius(j) / reach;
            let (v, of_first) = first.motion(i, near.arms[0]);
            let (u, of_second) = second.motion(j, mirror.turn(near.arms[1]));
            let meeting = Meeting {
                touch: Touch { overlap: near.overlap, radius, length: reach },
                normal: near.normal,
                scale: near.scale,
                arms: near.arms,
                velocity: v - mirror.turn(u),
            };
            let inverse_mass = |n: DVec3| (of_first + of_second).dot(n * n);
            let response = self.interaction.respond(&meeting, inverse_mass, dt, &before);
            losses.add_work(share(key), &response.memory, meeting.velocity, dt);
            losses.keep(share(key), &before, &response.memory);
            tally.stored += share(key) * (response.spring.energy + response.memory.energy());
            self.stiffness[0].add(i, response.spring.stiffness * of_first.dot(near.normal * near.normal));
            self.stiffness[other_side]
                .add(j, response.spring.stiffness * of_second.dot(near.normal * near.normal));
            self.memories.keep(key, response.memory);
            self.forces.push(Push { pair: key, arms: near.arms, force: share(key) * response.force });
        }
        while let Some((old, memory)) = self.memories.ended_before(None) {
            end(&mut losses, old, &memory);
        }
        self.memories.turn();
        tally.losses = losses;
        Ok(tally)
    }

    /// The forces on both sides, in the order of pairs: exactly opposite, at one place, mirrored where an image is touched.
    fn apply(&self, step: &Step<'_>) -> Result<(), StepError> {
        let families = Families::of(step.resources);
        for (side, body) in [self.first.body, self.second.body].into_iter().enumerate() {
            let (view, rows) = step.world.body_view(body);
            let mut force = view.write::<Force>()?;
            for Push { pair: (i, j), arms, force: push } in &self.forces {
                let (number, arm, push) = if side == 0 {
                    (i, arms[0], *push)
                } else {
                    (j, self.mirror.turn(arms[1]), -self.mirror.turn(*push))
                };
                families.push(&mut force, rows.start + *number as usize, arm, push);
            }
        }
        Ok(())
    }

    fn propose(&mut self, step: &mut Step<'_>, speed: f64) {
        let other_side = usize::from(self.first.body != self.second.body);
        let stiffest = self.forces.iter().map(|Push { pair: (i, j), .. }| {
            self.stiffness[0].of(*i as usize) + self.stiffness[other_side].of(*j as usize)
        });
        let stiffest = stiffest.fold(0.0, f64::max);
        self.stiffness.iter_mut().for_each(NodeStiffness::clear);
        let bodies = (self.first.body, self.second.body);
        super::stiffness::propose(step, bodies, stiffest, speed, self.least_now);
    }
}
