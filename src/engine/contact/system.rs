//! The system of all contacts of a scene.

use super::memory::{Memories, Memory, PairKey};
use super::particles::ParticleContact;
use super::start;
use super::surface::SurfaceContact;
use super::tally::{self, Tally};
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::plugin::SimBuilder;
use crate::rigid::RigidBodies;
use crate::schedule::{Mode, Run, Stage, Step, StepError, System};
use crate::world::{BodyId, BodySet, Force, Mobility, Position, ReferencePosition, Removed, Velocity};

/// Label of the system that makes the forces of contact.
pub const CONTACT: &str = "contact";

/// Two bodies that touch.
pub(super) enum Touching {
    Particles(Box<ParticleContact>),
    Surface(Box<SurfaceContact>),
}

impl Touching {
    /// The two bodies.
    pub fn bodies(&self) -> [BodyId; 2] {
        match self {
            Self::Particles(contact) => [contact.first, contact.second],
            Self::Surface(contact) => [contact.sides.first, contact.sides.second],
        }
    }

    fn run(&mut self, step: &mut Step<'_>, speeds: [f64; 2]) -> Result<Tally, StepError> {
        match self {
            Self::Particles(contact) => contact.run(step, speeds),
            Self::Surface(contact) => contact.run(step, speeds),
        }
    }

    fn memories(&self) -> &Memories {
        match self {
            Self::Particles(contact) => &contact.memories,
            Self::Surface(contact) => &contact.memories,
        }
    }

    fn memories_mut(&mut self) -> &mut Memories {
        match self {
            Self::Particles(contact) => &mut contact.memories,
            Self::Surface(contact) => &mut contact.memories,
        }
    }
}

/// Adds the system of the pairs; `numbers` are those of their contacts in the scene.
pub(super) fn add(sim: &mut SimBuilder<'_>, touching: Vec<Touching>, numbers: Vec<usize>, bodies: &BodySet) {
    start::refuse_bodies_within_others(sim, &touching, numbers);
    let phases = sim.phases_of(bodies);
    let contacts = Contacts {
        bodies: bodies.iter().map(|body| (body, 0.0)).collect(),
        tallies: Vec::with_capacity(touching.len()),
        touching,
    };
    sim.add_system(
        System::new(Stage::External, CONTACT, contacts)
            .on_phases(phases)
            .reads::<Position>()
            .reads::<ReferencePosition>()
            .reads::<Velocity>()
            .reads::<Mobility>()
            .reads::<Removed>()
            .adds::<Force>()
            .touches("rigid_bodies", Mode::Adds),
    );
}

struct Contacts {
    /// Bodies with their largest speed, m/s.
    bodies: Vec<(BodyId, f64)>,
    touching: Vec<Touching>,
    tallies: Vec<((BodyId, BodyId), Tally)>,
}

#[derive(Clone, Copy, Default)]
struct Largest(f64);

impl BlockSum for Largest {
    fn add(&mut self, next: &Self) {
        // Not the larger one of the two by `max`, which would drop what is not a number.
        if next.0.is_nan() || next.0 > self.0 {
            self.0 = next.0;
        }
    }
}

fn largest_speed(step: &Step<'_>, body: BodyId) -> Result<f64, StepError> {
    if let Some(bodies) = step.resources.try_get::<RigidBodies>()
        && let Some(rigid) = bodies.lock().iter().find(|rigid| rigid.id == body)
    {
        // The points that touch are farther out than the particles.
        return Ok(rigid.largest_speed());
    }
    let (view, rows) = step.world.body_view(body);
    let velocity = view.read::<Velocity>()?;
    let squared = sum_over_blocks(&velocity[rows], &|_, rows: &[Velocity]| {
        Largest(rows.iter().map(|v| v.0.length_squared()).fold(0.0, f64::max))
    });
    Ok(squared.0.sqrt())
}

impl Run for Contacts {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for (body, speed) in &mut self.bodies {
            *speed = largest_speed(step, *body)?;
        }
        let speed_of =
            |body: BodyId| self.bodies.iter().find(|(id, _)| *id == body).map_or(0.0, |entry| entry.1);
        self.tallies.clear();
        for pair in &mut self.touching {
            let [first, second] = pair.bodies();
            let tally = pair.run(step, [speed_of(first), speed_of(second)])?;
            self.tallies.push(((first, second), tally));
        }
        tally::book(step, &self.tallies);
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        let entries: Vec<_> = self.touching.iter().map(|pair| pair.memories().entries()).collect();
        postcard::to_stdvec(&entries).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Ok(entries) = postcard::from_bytes::<Vec<Vec<(PairKey, Memory)>>>(state) else { return false };
        if entries.len() != self.touching.len() {
            return false;
        }
        self.touching.iter_mut().zip(entries).for_each(|(pair, entries)| pair.memories_mut().set(entries));
        true
    }
}
