//! Contact of nodes with the exact surface of a rigid body: of particles of a deformable body, of the points of another rigid
//! body.

use glam::DVec3;

use super::nearby::{NEAR, Nearby};
use super::reaction::{Push, push};
use crate::contact::active::{ActiveContacts, ContactNodes, End, Pull};
use crate::contact::bodies::{MotionBounds, Nearness, NodeMotion, NodeView, Particles, Sides};
use crate::contact::laws::Touch;
use crate::contact::response::{
    ContactEnergy, ContactState, History, Interaction, Losses, PairKey, time_step,
};
use crate::parallel::BlockSum;
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::{Step, StepError};

/// Layers of particles of a side for which there is room from the start.
const LAYERS: usize = 3;

/// Contact of the nodes of one body with the surface of another.
pub(in crate::contact) struct SurfaceContact {
    interaction: Interaction,
    pub sides: Sides,
    /// Acceleration of gravity, m/s2.
    gravity: f64,
    nearby: Nearby,
    pub contacts: ActiveContacts<Meet, Push, Frequencies>,
    /// The particles that touch.
    pub contact_nodes: ContactNodes,
}

/// A node that touches.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct Meet {
    /// The image of the node that is near the surface, m, and from there to the node: zero, or a period.
    x: DVec3,
    shift: DVec3,
    /// Nearest point of the surface, m.
    point: DVec3,
    near: Nearness,
}

/// What the nodes near the surface say of the time step.
#[derive(Clone, Copy)]
pub(in crate::contact) struct Frequencies {
    /// Least way to the centre of a particle near the surface that just touches, m.
    least: f64,
    /// The first particle near the surface that nothing moves but conditions.
    held: Option<usize>,
}

impl Default for Frequencies {
    fn default() -> Self {
        Self { least: f64::INFINITY, held: None }
    }
}

impl BlockSum for Frequencies {
    fn add(&mut self, next: &Self) {
        self.least = self.least.min(next.least);
        self.held = self.held.or(next.held);
    }
}

impl SurfaceContact {
    /// Contact of the nodes of a body with the surface of another.
    pub fn new(interaction: Interaction, sides: Sides, gravity: f64) -> Self {
        let particles = sides.nodes.particles();
        let count = particles.map_or(0, |particles| particles.radius.len());
        let nearby = Nearby::new(count, particles.map_or(0.0, Particles::largest));
        let room = particles.map_or(0, |particles| LAYERS * particles.on_a_side);
        let (mut contacts, mut contact_nodes) = (ActiveContacts::default(), ContactNodes::new(count));
        contacts.reserve(room);
        contact_nodes.reserve(room);
        Self { interaction, gravity, nearby, sides, contacts, contact_nodes }
    }

    /// Works out the forces of all nodes that touch, and pushes the rigid bodies.
    pub fn run(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<ContactEnergy, StepError> {
        let resources = step.resources;
        let mut bodies = resources.get_mut::<RigidBodies>();
        let speed = motion[0].speed + motion[1].speed;
        let dt = step.clock.dt;
        let Self { interaction, sides, nearby, contacts, gravity, contact_nodes } = self;
        let of_particles = sides.nodes.particles();
        let (energies, near, expected) = sides.with(step.world, step.resources, &bodies, |nodes, tool| {
            let is_new = nearby.update(sides, nodes, tool, speed * dt, motion[0].stretch);
            if is_new && of_particles.is_some() {
                contact_nodes.renew(nearby.candidates(), &[End::First]);
            }
            if of_particles.is_none() {
                contacts.reserve(nodes.len());
            }
            let near = find(sides, nodes, tool, nearby.candidates(), contacts);
            let energies = evaluate(interaction, sides, nodes, tool, dt, contacts);
            (energies, near, expected(interaction, nodes, tool, near.held, speed, *gravity))
        })?;
        let pushes = contacts.pushes();
        contact_nodes.add_up(contacts.numbers(), &|number, _| {
            let Push { force, arm, turning, stiffness, heat, .. } = pushes[number];
            Pull { force, arm, beside: turning, stiffness: stiffness[0], heat: interaction.heat[0] * heat }
        });
        let [particle, rigid] = push(sides, pushes, &mut bodies);
        let squared = rigid + if of_particles.is_some() { contact_nodes.stiffest() } else { particle };
        let pair = (sides.first, sides.second);
        match of_particles {
            Some(particles) if expected == 0.0 => {
                time_step::propose(step, pair, squared, speed, 2.0 * near.least.min(particles.least()));
            }
            _ => time_step::propose_rigid(step, pair, squared.max(expected)),
        }
        Ok(energies)
    }
}

/// The squared frequency of the impact that a rigid body may make at `speed` on another one or on particles that do not give way, 1/s2: a
/// spring that gets stiffer with depth, or has no mass that would limit the step by itself, must not come as a surprise.
fn expected(
    interaction: &Interaction,
    nodes: &NodeView<'_>,
    tool: &RigidBody,
    held: Option<usize>,
    speed: f64,
    gravity: f64,
) -> f64 {
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
    let gain = gravity.max(own_pull).max(pull(tool));
    let speed = speed + (2.0 * gain * touch.length).sqrt();
    interaction.law.stiffness_of_impact(&touch, 1.0 / inverse_mass, speed) * inverse_mass
}

/// Finds the nodes that touch.
fn find(
    sides: &Sides,
    nodes: &NodeView<'_>,
    tool: &RigidBody,
    candidates: &[PairKey],
    contacts: &mut ActiveContacts<Meet, Push, Frequencies>,
) -> Frequencies {
    contacts.find(candidates, |(node, _), frequencies: &mut Frequencies| {
        let i = node as usize;
        let own_place = nodes.position(i);
        let x = sides.near(own_place, tool);
        let nearest = tool.surface.closest(tool.reference(x));
        let normal = tool.state.rotation * nearest.normal;
        let near = nodes.nearness(i, nearest.signed_distance, normal);
        if near.overlap <= -NEAR * near.scale * nodes.size(i) || !nodes.is_there(i) {
            return None;
        }
        let held = nodes.is_held(i).then_some(i);
        frequencies.add(&Frequencies { least: nodes.radius(i) / near.scale, held });
        let touches = near.overlap > 0.0;
        // Where the body of the node has it, a period away from the image that touches.
        touches.then(|| Meet { x, shift: own_place - x, point: nearest.point, near })
    })
}

/// Works out what every node that touches does.
fn evaluate(
    interaction: &Interaction,
    sides: &Sides,
    nodes: &NodeView<'_>,
    tool: &RigidBody,
    dt: f64,
    contacts: &mut ActiveContacts<Meet, Push, Frequencies>,
) -> ContactEnergy {
    let moving = !interaction.is_elastic();
    // The forces of the last step on the motion of this one, where they act: at the node and, for a particle, `arm` beside it.
    let work_before = |node: u32, motion: &NodeMotion<'_>, history: &History, losses: &mut Losses| {
        if !history.is_elastic() {
            let (i, arm) = (node as usize, history.arms[0]);
            let own_place = nodes.position(i);
            let x = sides.near(own_place, tool);
            let surface = || tool.place(tool.surface.closest(tool.reference(x)).point);
            let place = nodes.place(i, x, arm, surface);
            let velocity = motion.velocity(arm, place + (own_place - x)) - tool.velocity_at(place);
            losses.add_work(1.0, history, velocity, dt);
        }
    };
    let respond = |(node, _): PairKey, meet: &Meet, before: &History, energies: &mut ContactEnergy| {
        let i = node as usize;
        let motion = nodes.motion(i, moving || before.is_none());
        let mut losses = Losses::default();
        work_before(node, &motion, before, &mut losses);
        let Meet { x, shift, point, near } = *meet;
        let (arm, normal) = (near.arms[0], near.normal);
        let place = nodes.place(i, x, arm, || tool.place(point));
        let state = ContactState {
            touch: touch_of(nodes, i, tool, near.overlap),
            normal,
            scale: near.scale,
            area: 1.0,
            arms: near.arms,
            velocity: motion.velocity(arm, place + shift) - tool.velocity_at(place),
        };
        let own = motion.inverse_mass(arm, place + shift);
        let inverse_mass = |n: DVec3| own(n) + tool.inverse_mass_at(place, n);
        let response = interaction.respond(&state, inverse_mass, dt, before);
        losses.add_work(1.0, &response.history, state.velocity, dt);
        losses.keep(1.0, before, &response.history);
        energies.losses.add(&losses);
        let heat = losses.friction;
        energies.stored += response.spring.energy + response.history.energy();
        let turning = if arm == DVec3::ZERO {
            DVec3::ZERO
        } else {
            -response.spring.force * turn_of_normal(tool, x, normal, x - place)
        };
        let stiffness = [own(normal), tool.inverse_mass_at(place, normal)];
        let stiffness = stiffness.map(|inverse_mass| response.spring.stiffness * inverse_mass);
        (
            response.history,
            Push { arm, place, shift, force: response.force, center: x, turning, heat, stiffness },
        )
    };
    let end = |(node, _): PairKey, history: &History, energies: &mut ContactEnergy| {
        let i = node as usize;
        let motion = nodes.motion(i, moving);
        work_before(node, &motion, history, &mut energies.losses);
        energies.losses.keep(1.0, history, &History::default());
        if !nodes.is_there(i) {
            let x = sides.near(nodes.position(i), tool);
            let nearest = tool.surface.closest(tool.reference(x));
            let state = ContactState {
                touch: touch_of(nodes, i, tool, history.overlap),
                normal: tool.state.rotation * nearest.normal,
                scale: 1.0,
                area: 1.0,
                arms: history.arms,
                velocity: motion.velocity(DVec3::ZERO, x) - tool.velocity_at(x),
            };
            energies.removed += interaction.held(&state, dt, history);
        }
    };
    contacts.respond(respond, end)
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
    let depth = if matches!(nodes, NodeView::Particles(_)) { own } else { f64::INFINITY };
    Touch { overlap, radius, length, depth }
}
