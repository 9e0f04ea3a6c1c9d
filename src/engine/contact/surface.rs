//! Contact of nodes with the exact surface of a rigid body: of particles of a deformable body, of the points of another rigid
//! body.

use glam::DVec3;

use super::law::Touch;
use super::memory::Memories;
use super::node_view::NodeView;
use super::response::{Interaction, Losses, Meeting};
use super::sides::{Nodes, Sides};
use super::stiffness::{self, NodeStiffness};
use super::tally::Tally;
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::{Step, StepError};
use crate::world::Force;

/// Skin over the size of a node.
const SKIN: f64 = 0.5;

/// Contact of the nodes of one body with the surface of another.
pub(super) struct SurfaceContact {
    interaction: Interaction,
    pub sides: Sides,
    /// Acceleration of gravity, m/s2.
    gravity: f64,
    pub memories: Memories,
    /// Nodes that may touch, ascending.
    candidates: Vec<u32>,
    budget: f64,
    travelled: f64,
    stiffness: NodeStiffness,
    /// The nodes that touch now.
    forces: Vec<Push>,
}

/// What a contact does to both sides.
struct Push {
    node: u32,
    /// Where the surface is pushed, m.
    place: DVec3,
    /// From there to where the node is pushed: zero, or a period.
    shift: DVec3,
    /// Force on the node, N.
    force: DVec3,
}

/// Stiffness over mass of the contacts of a step, 1/s2.
#[derive(Default)]
struct Frequencies {
    /// Of the rigid bodies.
    rigid: f64,
    /// The largest of a particle.
    particle: f64,
}

impl SurfaceContact {
    /// Contact of the nodes of a body with the surface of another.
    pub fn new(interaction: Interaction, sides: Sides, gravity: f64) -> Self {
        let count = if let Nodes::Particles(radius) = &sides.nodes { radius.len() } else { 0 };
        Self {
            interaction,
            sides,
            gravity,
            memories: Memories::default(),
            candidates: Vec::new(),
            budget: -1.0,
            travelled: 0.0,
            stiffness: NodeStiffness::new(count),
            forces: Vec::new(),
        }
    }

    /// Adds the forces of all nodes that touch; `speeds` are the largest of each body, m/s.
    pub fn run(&mut self, step: &mut Step<'_>, speeds: [f64; 2]) -> Result<Tally, StepError> {
        let shared = step.resources.get::<RigidBodies>().clone();
        let mut bodies = shared.lock();
        let speed = speeds[0] + speeds[1];
        self.travelled += speed * step.clock.dt;
        // A distance that is not a number must not keep old candidates.
        if self.travelled.is_nan() || self.travelled > self.budget {
            self.travelled = 0.0;
            let mut candidates = std::mem::take(&mut self.candidates);
            self.budget = self
                .sides
                .with(step.world, &bodies, |nodes, tool| self.candidates(nodes, tool, &mut candidates))?;
            self.candidates = candidates;
        }
        let mut memories = std::mem::take(&mut self.memories);
        let mut forces = std::mem::take(&mut self.forces);
        let mut sums = std::mem::replace(&mut self.stiffness, NodeStiffness::new(0));
        forces.clear();
        let dt = step.clock.dt;
        let (tally, mut frequencies, least) = self.sides.with(step.world, &bodies, |nodes, tool| {
            let (tally, frequencies) = self.evaluate(nodes, tool, dt, &mut memories, &mut forces, &mut sums);
            let least = self.expected(nodes, tool, speed);
            (tally, frequencies, least)
        })?;
        (self.memories, self.forces) = (memories, forces);
        for push in &self.forces {
            if matches!(self.sides.nodes, Nodes::Particles(_)) {
                frequencies.particle = frequencies.particle.max(sums.of(push.node as usize));
            }
        }
        sums.clear();
        self.stiffness = sums;
        self.apply(step, &mut bodies)?;
        let pair = (self.sides.first, self.sides.second);
        let squared = frequencies.rigid + frequencies.particle;
        match &self.sides.nodes {
            Nodes::Particles(_) => stiffness::propose(step, pair, squared, speed, 2.0 * least),
            Nodes::Rigid => stiffness::propose_rigid(step, pair, squared.max(least)),
        }
        Ok(tally)
    }

    /// For particles their least radius, m; for a rigid body the squared frequency of the impact that it may make at
    /// `speed`, 1/s2: a spring that gets stiffer with depth must not come as a surprise.
    fn expected(&self, nodes: &NodeView<'_>, tool: &RigidBody, speed: f64) -> f64 {
        let NodeView::Rigid(body) = nodes else { return nodes.least_radius() };
        let inverse = |body: &RigidBody| if body.is_driven() { 0.0 } else { 1.0 / body.mass };
        let inverse_mass = inverse(body) + inverse(tool);
        if inverse_mass == 0.0 {
            return 0.0;
        }
        let touch = touch_of(nodes, 0, tool, 0.0);
        // A body at rest may fall: what it gains over the length of a node counts as its speed.
        let acceleration = |body: &RigidBody| (body.state.force / body.mass).length();
        let gain = self.gravity.max(acceleration(body)).max(acceleration(tool));
        let speed = speed + (2.0 * gain * touch.length).sqrt();
        self.interaction.law.stiffness_of_impact(&touch, 1.0 / inverse_mass, speed) * inverse_mass
    }

    fn evaluate(
        &self,
        nodes: &NodeView<'_>,
        tool: &RigidBody,
        dt: f64,
        memories: &mut Memories,
        forces: &mut Vec<Push>,
        sums: &mut NodeStiffness,
    ) -> (Tally, Frequencies) {
        let mut tally = Tally::default();
        let mut losses = Losses::default();
        let mut frequencies = Frequencies::default();
        let slip = |node: u32, place: DVec3, shift: DVec3| {
            nodes.velocity(node as usize, place + shift) - tool.velocity_at(place)
        };
        let ended = |node: u32| {
            let own_place = nodes.position(node as usize);
            let place = self.sides.near(own_place, tool);
            slip(node, place, own_place - place)
        };
        for &node in &self.candidates {
            let i = node as usize;
            let own_place = nodes.position(i);
            let x = self.sides.near(own_place, tool);
            let nearest = tool.surface.closest(tool.reference(x));
            let overlap = nodes.radius(i) - nearest.signed_distance;
            if overlap <= 0.0 || !nodes.is_there(i) {
                continue;
            }
            while let Some((old, memory)) = memories.ended_before(Some((node, 0))) {
                losses.add(&memory, &Default::default(), ended(old.0), dt);
            }
            let before = memories.of((node, 0));
            let place = nodes.place(x, || tool.place(nearest.point));
            // Where the body of the node has it, a period away from the image that touches.
            let shift = own_place - x;
            let meeting = Meeting {
                touch: touch_of(nodes, i, tool, overlap),
                normal: tool.state.rotation * nearest.normal,
                velocity: slip(node, place, shift),
            };
            let own = |n: DVec3| nodes.inverse_mass(i, place + shift, n);
            let inverse_mass = |n: DVec3| own(n) + tool.inverse_mass_at(place, n);
            let response = self.interaction.respond(&meeting, inverse_mass, dt, &before);
            losses.add(&before, &response.memory, meeting.velocity, dt);
            tally.stored += response.spring.energy + response.memory.energy();
            let stiffness = response.spring.stiffness;
            frequencies.rigid += stiffness * tool.inverse_mass_at(place, meeting.normal);
            match nodes {
                NodeView::Particles { .. } => sums.add(i, stiffness * own(meeting.normal)),
                NodeView::Rigid(_) => frequencies.rigid += stiffness * own(meeting.normal),
            }
            memories.keep((node, 0), response.memory);
            forces.push(Push { node, place, shift, force: response.force });
        }
        while let Some((old, memory)) = memories.ended_before(None) {
            losses.add(&memory, &Default::default(), ended(old.0), dt);
        }
        memories.turn();
        tally.losses = losses;
        (tally, frequencies)
    }

    /// The forces on both sides: exactly opposite, at one place.
    fn apply(&self, step: &Step<'_>, bodies: &mut [RigidBody]) -> Result<(), StepError> {
        if let Nodes::Particles(_) = self.sides.nodes {
            let (view, rows) = step.world.body_view(self.sides.first);
            let mut column = view.write::<Force>()?;
            for push in &self.forces {
                column[rows.start + push.node as usize].0 += push.force;
            }
        }
        for body in bodies.iter_mut() {
            for Push { place, shift, force, .. } in &self.forces {
                if body.id == self.sides.second {
                    body.push(*place, -*force);
                } else if body.id == self.sides.first {
                    body.push(*place + *shift, *force);
                }
            }
        }
        Ok(())
    }

    /// Finds the nodes near the surface; returns how far both bodies may move together until others are, m.
    fn candidates(&self, nodes: &NodeView<'_>, tool: &RigidBody, candidates: &mut Vec<u32>) -> f64 {
        candidates.clear();
        let bounds = tool.surface.bounds();
        let mut budget = f64::INFINITY;
        for i in 0..nodes.len() {
            let x = tool.reference(self.sides.near(nodes.position(i), tool));
            let (reach, skin) = (nodes.radius(i), SKIN * nodes.size(i));
            let gap = (bounds.min - x).max(x - bounds.max).max(DVec3::ZERO).length() - reach;
            if gap < skin {
                budget = budget.min(skin);
                if tool.surface.closest(x).signed_distance - reach < skin {
                    candidates.push(i as u32);
                }
            } else {
                budget = budget.min(gap);
            }
        }
        budget
    }
}

fn touch_of(nodes: &NodeView<'_>, i: usize, tool: &RigidBody, overlap: f64) -> Touch {
    let length = nodes.size(i);
    let own = if nodes.radius(i) > 0.0 { nodes.radius(i) } else { 0.5 * length };
    let radius = tool.nodes.sphere().map_or(own, |other| own * other / (own + other));
    Touch { overlap, radius, length }
}
