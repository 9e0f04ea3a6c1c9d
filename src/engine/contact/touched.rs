//! The particles of a body that touch in a step. What their neighbourhoods do is worked out once for each, and so is what acts on them.

use glam::{DMat3, DVec3};

use super::members::Members;
use crate::formulations::total_lagrangian::{PackedRows, Surroundings};
use crate::parallel::for_each_heavy_block;
use crate::world::Force;

/// In the place of a number in the list for particles that do not touch.
const NONE: u32 = u32::MAX;

/// The particles that touch.
pub(super) struct Touched {
    /// Number in the lists of every particle of the body.
    numbers: Vec<u32>,
    nodes: Vec<u32>,
    surroundings: Vec<Surroundings>,
    /// Sum of the forces on each, N.
    forces: Vec<DVec3>,
    /// Sums of f (x) A of forces on points A beside it, N m.
    couples: Vec<DMat3>,
    /// Sums of stiffness over mass of the contacts of each, 1/s2: a bound on the square of a frequency (Gershgorin).
    stiffness: Vec<f64>,
}

impl Touched {
    /// None of that many particles.
    pub fn new(particles: usize) -> Self {
        let (nodes, surroundings, forces) = (Vec::new(), Vec::new(), Vec::new());
        let (couples, stiffness) = (Vec::new(), Vec::new());
        Self { numbers: vec![NONE; particles], nodes, surroundings, forces, couples, stiffness }
    }

    /// Forgets the particles of the last step.
    pub fn clear(&mut self) {
        for node in self.nodes.drain(..) {
            self.numbers[node as usize] = NONE;
        }
        self.forces.clear();
        self.couples.clear();
        self.stiffness.clear();
    }

    /// Makes room for that many particles.
    pub fn reserve(&mut self, count: usize) {
        let particles = self.numbers.len();
        if self.nodes.capacity() < count.min(particles) {
            let count = (2 * count).min(particles);
            let more = count - self.nodes.len();
            self.nodes.reserve(more);
            self.surroundings.reserve(count - self.surroundings.len());
            self.forces.reserve(more);
            self.couples.reserve(more);
            self.stiffness.reserve(more);
        }
    }

    /// Takes in a particle.
    pub fn take_in(&mut self, node: u32) {
        let number = &mut self.numbers[node as usize];
        if *number == NONE {
            *number = self.nodes.len() as u32;
            self.nodes.push(node);
            self.forces.push(DVec3::ZERO);
            self.couples.push(DMat3::ZERO);
            self.stiffness.push(0.0);
        }
    }

    /// Looks at the surroundings of all that were taken in, and at how they move, if that is asked for.
    pub fn look(&mut self, members: &Members<'_>, moving: bool) {
        self.surroundings.clear();
        self.surroundings.resize(self.nodes.len(), Surroundings::default());
        let rows = (&self.nodes[..], &mut self.surroundings[..]);
        for_each_heavy_block(rows, &mut Vec::new(), &|_, (nodes, found): (&[u32], &mut [Surroundings])| {
            for (node, found) in nodes.iter().zip(found) {
                *found = members.surroundings(*node as usize, moving);
            }
        });
    }

    /// The surroundings of a particle that was taken in.
    pub fn surroundings(&self, node: u32) -> &Surroundings {
        &self.surroundings[self.numbers[node as usize] as usize]
    }

    /// Adds a force, N, on the point `arm` beside a particle that was taken in, with its stiffness over mass, 1/s2.
    pub fn add(&mut self, node: u32, force: DVec3, arm: DVec3, stiffness: f64) {
        let number = self.numbers[node as usize] as usize;
        self.forces[number] += force;
        self.couples[number] += DMat3::from_cols(force * arm.x, force * arm.y, force * arm.z);
        self.stiffness[number] += stiffness;
    }

    /// Stiffness over mass of the contacts of a particle that was taken in, 1/s2.
    pub fn stiffness(&self, node: u32) -> f64 {
        self.stiffness[self.numbers[node as usize] as usize]
    }

    /// Adds what acts on the neighbourhoods; `first` is the first row of the body.
    pub fn add_couples(&self, packed: &mut PackedRows, first: usize) {
        if !self.nodes.is_empty() {
            packed.add_couples(first, &self.numbers, &self.couples);
        }
    }

    /// Adds what acts on the particles of a body.
    pub fn add_forces(&self, force: &mut [Force]) {
        for (node, push) in self.nodes.iter().zip(&self.forces) {
            force[*node as usize].0 += *push;
        }
    }
}
