//! Contact of nodes with the exact surface of a rigid body: of particles of a deformable body, of the points of another rigid
//! body.

use glam::DVec3;

use super::law::Touch;
use super::memory::{Memories, Memory, PairKey};
use super::node_view::NodeView;
use super::response::{Interaction, Losses, Meeting};
use super::sides::{Nodes, Sides};
use super::stiffness::{self, NodeStiffness};
use super::system::Pace;
use super::tally::Tally;
use crate::formulations::total_lagrangian::Families;
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::{Step, StepError};
use crate::world::Force;

/// Skin over the size of a node.
const SKIN: f64 = 1.0;
/// Gap, over the size of a node, up to which a node counts as near the surface. All that are so near are candidates whenever the list was made, so
/// that what follows from them follows from positions alone.
const NEAR: f64 = 0.5;

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
    /// Largest radius of a node, m, and how far nodes were stretched at most when the candidates were found.
    largest: f64,
    stretch: f64,
    stiffness: NodeStiffness,
    /// The nodes that touch now.
    forces: Vec<Push>,
}

/// What a contact does to both sides.
struct Push {
    node: u32,
    /// From the node to where it is pushed, in the reference configuration, m.
    arm: DVec3,
    /// Where the surface is pushed, m.
    place: DVec3,
    /// From there to where the node is pushed: zero, or a period.
    shift: DVec3,
    /// Force on the node, N.
    force: DVec3,
    /// The place of a particle, m, and a force on it and, opposite, on the other body there, because the normal turns as it moves, N.
    center: DVec3,
    turning: DVec3,
}

/// Stiffness over mass of the contacts of a step, 1/s2.
struct Frequencies {
    /// Of the rigid bodies.
    rigid: f64,
    /// The largest of a particle.
    particle: f64,
    /// Least way to the centre of a particle near the surface that just touches, m.
    least: f64,
    /// A particle near the surface that nothing moves but conditions.
    held: Option<usize>,
}

impl SurfaceContact {
    /// Contact of the nodes of a body with the surface of another.
    pub fn new(interaction: Interaction, sides: Sides, gravity: f64) -> Self {
        let (count, largest) = match &sides.nodes {
            Nodes::Particles(particles) => (particles.radius.len(), particles.largest()),
            Nodes::Rigid => (0, 0.0),
        };
        Self {
            interaction,
            sides,
            gravity,
            memories: Memories::default(),
            candidates: Vec::with_capacity(count),
            budget: -1.0,
            travelled: 0.0,
            largest,
            stretch: 1.0,
            stiffness: NodeStiffness::new(count),
            forces: Vec::new(),
        }
    }

    /// Adds the forces of all nodes that touch.
    pub fn run(&mut self, step: &mut Step<'_>, paces: [Pace; 2]) -> Result<Tally, StepError> {
        let shared = step.resources.get::<RigidBodies>().clone();
        let mut bodies = shared.lock();
        let speed = paces[0].speed + paces[1].speed;
        self.travelled += speed * step.clock.dt;
        let used = self.travelled + self.largest * (paces[0].stretch - self.stretch).max(0.0);
        // A distance that is not a number must not keep old candidates.
        if used.is_nan() || used > self.budget {
            (self.travelled, self.stretch) = (0.0, paces[0].stretch);
            let mut candidates = std::mem::take(&mut self.candidates);
            self.budget = self.sides.with(step.world, step.resources, &bodies, |nodes, tool| {
                self.candidates(nodes, tool, &mut candidates)
            })?;
            self.candidates = candidates;
        }
        let mut memories = std::mem::take(&mut self.memories);
        let mut forces = std::mem::take(&mut self.forces);
        let mut sums = std::mem::replace(&mut self.stiffness, NodeStiffness::new(0));
        forces.clear();
        let dt = step.clock.dt;
        let (tally, mut frequencies, expected) =
            self.sides.with(step.world, step.resources, &bodies, |nodes, tool| {
                let (tally, frequencies) =
                    self.evaluate(nodes, tool, dt, &mut memories, &mut forces, &mut sums);
                let expected = self.expected(nodes, tool, frequencies.held, speed);
                (tally, frequencies, expected)
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
            Nodes::Particles(_) if expected > 0.0 => {
                stiffness::propose_rigid(step, pair, squared.max(expected));
            }
            Nodes::Particles(particles) => {
                let least = frequencies.least.min(particles.least());
                stiffness::propose(step, pair, squared, speed, 2.0 * least);
            }
            Nodes::Rigid => stiffness::propose_rigid(step, pair, squared.max(expected)),
        }
        Ok(tally)
    }

    /// The squared frequency of the impact that a rigid body may make at `speed` on another one or on particles that do not give way, 1/s2: a
    /// spring that gets stiffer with depth, or has no mass that would limit the step by itself, must not come as a surprise.
    fn expected(&self, nodes: &NodeView<'_>, tool: &RigidBody, held: Option<usize>, speed: f64) -> f64 {
        let inverse = |body: &RigidBody| if body.is_driven() { 0.0 } else { 1.0 / body.mass };
        let pull = |body: &RigidBody| (body.state.force / body.mass).length();
        let (node, inverse_mass, own_pull) = match (nodes, held) {
            (NodeView::Rigid(body), _) => (0, inverse(body) + inverse(tool), pull(body)),
            (NodeView::Particles(_), Some(node)) => (node, inverse(tool), 0.0),
            (NodeView::Particles(_), None) => return 0.0,
        };
        if inverse_mass == 0.0 {
            return 0.0;
        }
        let touch = touch_of(nodes, node, tool, 0.0);
        // A body at rest may fall: what it gains over the length of a node counts as its speed.
        let gain = self.gravity.max(own_pull).max(pull(tool));
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
        let mut frequencies = Frequencies { rigid: 0.0, particle: 0.0, least: f64::INFINITY, held: None };
        let slip = |node: u32, arm: DVec3, place: DVec3, shift: DVec3| {
            nodes.velocity(node as usize, arm, place + shift) - tool.velocity_at(place)
        };
        // The forces of the last step on the motion of this one, where they act: at the node and, for a particle, `arm` beside it.
        let work_before = |losses: &mut Losses, node: u32, memory: &Memory| {
            if !memory.is_elastic() {
                let (i, arm) = (node as usize, memory.arms[0]);
                let own_place = nodes.position(i);
                let x = self.sides.near(own_place, tool);
                let surface = || tool.place(tool.surface.closest(tool.reference(x)).point);
                let velocity = slip(node, arm, nodes.place(i, x, arm, surface), own_place - x);
                losses.add_work(1.0, memory, velocity, dt);
            }
        };
        let end = |losses: &mut Losses, (node, _): PairKey, memory: &Memory| {
            work_before(losses, node, memory);
            losses.keep(1.0, memory, &Memory::default());
        };
        for &node in &self.candidates {
            let i = node as usize;
            let own_place = nodes.position(i);
            let x = self.sides.near(own_place, tool);
            let nearest = tool.surface.closest(tool.reference(x));
            let normal = tool.state.rotation * nearest.normal;
            let near = nodes.nearness(i, nearest.signed_distance, normal);
            if near.overlap <= -NEAR * near.scale * nodes.size(i) || !nodes.is_there(i) {
                continue;
            }
            frequencies.least = frequencies.least.min(nodes.radius(i) / near.scale);
            frequencies.held = frequencies.held.or(nodes.is_held(i).then_some(i));
            if near.overlap <= 0.0 {
                continue;
            }
            while let Some((old, memory)) = memories.ended_before(Some((node, 0))) {
                end(&mut losses, old, &memory);
            }
            let before = memories.of((node, 0));
            work_before(&mut losses, node, &before);
            let arm = near.arms[0];
            let place = nodes.place(i, x, arm, || tool.place(nearest.point));
            // Where the body of the node has it, a period away from the image that touches.
            let shift = own_place - x;
            let (velocity, own) = nodes.motion(i, arm, place + shift);
            let meeting = Meeting {
                touch: touch_of(nodes, i, tool, near.overlap),
                normal,
                scale: near.scale,
                arms: near.arms,
                velocity: velocity - tool.velocity_at(place),
            };
            let inverse_mass = |n: DVec3| own(n) + tool.inverse_mass_at(place, n);
            let response = self.interaction.respond(&meeting, inverse_mass, dt, &before);
            losses.add_work(1.0, &response.memory, meeting.velocity, dt);
            losses.keep(1.0, &before, &response.memory);
            tally.stored += response.spring.energy + response.memory.energy();
            let stiffness = response.spring.stiffness;
            frequencies.rigid += stiffness * tool.inverse_mass_at(place, meeting.normal);
            match nodes {
                NodeView::Particles(_) => sums.add(i, stiffness * own(meeting.normal)),
                NodeView::Rigid(_) => frequencies.rigid += stiffness * own(meeting.normal),
            }
            memories.keep((node, 0), response.memory);
            let turning = if arm == DVec3::ZERO {
                DVec3::ZERO
            } else {
                -response.spring.force * turn_of_normal(tool, x, normal, x - place)
            };
            forces.push(Push { node, arm, place, shift, force: response.force, center: x, turning });
        }
        while let Some((old, memory)) = memories.ended_before(None) {
            end(&mut losses, old, &memory);
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
            let families = Families::of(step.resources);
            for push in &self.forces {
                let row = rows.start + push.node as usize;
                families.push(&mut column, row, push.arm, push.force);
                column[row].0 += push.turning;
            }
        }
        for body in bodies.iter_mut() {
            for Push { place, center, shift, force, turning, .. } in &self.forces {
                if body.id == self.sides.second {
                    body.push(*place, -*force);
                    body.push(*center, -*turning);
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
            let size = nodes.size(i);
            let (reach, skin, near) = (self.stretch * nodes.radius(i), SKIN * size, NEAR * size);
            let gap = (bounds.min - x).max(x - bounds.max).max(DVec3::ZERO).length() - reach;
            if gap < skin {
                budget = budget.min(skin - near);
                if tool.surface.closest(x).signed_distance - reach < skin {
                    candidates.push(i as u32);
                }
            } else {
                budget = budget.min(gap - near);
            }
        }
        budget
    }
}

/// How the normal of a surface turns as a particle moves along the part of `p` that is across it: on curved surfaces and beside edges the overlap
/// depends on that, because the reach of the particle does. Half-way inside a body normals jump, and there is no such thing.
fn turn_of_normal(tool: &RigidBody, x: DVec3, normal: DVec3, p: DVec3) -> DVec3 {
    const STEP: f64 = 1e-4;
    let across = p - p.dot(normal) * normal;
    let at = |s: f64| tool.surface.closest(tool.reference(x + s * across)).normal;
    let change = at(STEP) - at(-STEP);
    if change.length_squared() < 0.01 { tool.state.rotation * change / (2.0 * STEP) } else { DVec3::ZERO }
}

fn touch_of(nodes: &NodeView<'_>, i: usize, tool: &RigidBody, overlap: f64) -> Touch {
    let length = nodes.size(i);
    let own = if nodes.radius(i) > 0.0 { nodes.radius(i) } else { 0.5 * length };
    let radius = tool.nodes.sphere().map_or(own, |other| own * other / (own + other));
    Touch { overlap, radius, length }
}
