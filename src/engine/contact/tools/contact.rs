//! Contact of nodes with the exact surface of a rigid body: of particles of a deformable body, of the points of another rigid
//! body.

use super::nearby::Nearby;
use super::on_surface::{NearNodes, NodeTouch, OnSurface};
use super::reaction::{NodePush, push};
use crate::contact::active::{ActiveContacts, ContactNodes, End, Pull};
use crate::contact::bodies::{MotionBounds, Particles, Sides};
use crate::contact::response::time_step::{self, Touches};
use crate::contact::response::{ContactEnergy, Interaction};
use crate::rigid::RigidBodies;
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
    pub contacts: ActiveContacts<NodeTouch, NodePush, NearNodes>,
    /// The particles that touch.
    pub contact_nodes: ContactNodes,
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
        let (energies, near, expected, count) =
            sides.with(step.world, step.resources, &bodies, |nodes, tool| {
                let is_new = nearby.update(sides, nodes, tool, speed * dt, motion[0].stretch);
                if is_new && of_particles.is_some() {
                    contact_nodes.renew(nearby.candidates(), &[End::First]);
                }
                if of_particles.is_none() {
                    contacts.reserve(nodes.len());
                }
                let mut on = OnSurface { interaction, sides, nodes, tool, dt, together: None };
                let near = contacts.find(nearby.candidates(), |(node, _), near_nodes: &mut NearNodes| {
                    on.touching(node, near_nodes)
                });
                on.together = on.act_together(contacts.met());
                let energies = contacts.respond(
                    nodes.len(),
                    |(node, _), touch, before, energies| on.respond(node, touch, before, energies),
                    |(node, _), history, energies| on.end(node, history, energies),
                );
                let expected = on.expected(&near, speed, *gravity);
                (energies, near, expected, nodes.len())
            })?;
        let pushes = contacts.pushes();
        contact_nodes.add_up(contacts.numbers(), &|number, _| {
            let NodePush { force, arm, turning, stiffness, heat, .. } = pushes[number];
            Pull { force, arm, beside: turning, stiffness: stiffness[0], heat: interaction.heat[0] * heat }
        });
        let [particle, rigid] = push(sides, contacts.met(), pushes, count, &mut bodies);
        let squared = rigid + if of_particles.is_some() { contact_nodes.stiffest() } else { particle };
        let pair = (sides.first, sides.second);
        match of_particles {
            Some(particles) if expected == 0.0 => {
                let reach = 2.0 * near.least.0.min(particles.least());
                let touches = Touches { squared, stored: energies.stored, speed, reach };
                time_step::propose(step, pair, &touches)?;
            }
            _ => time_step::propose_rigid(step, pair, squared.max(expected)),
        }
        Ok(energies)
    }
}
