//! Contact of nodes with the exact surface of a rigid body: of particles of a deformable body, of the points
//! of another rigid body.

use super::nearby::Nearby;
use super::on_surface::{NearNodes, NodeTouch, OnSurface};
use super::reaction::{NodePush, push};
use super::together::CoupledResponse;
use crate::contact::active::{ActiveContacts, ContactEnd, ContactNodes, NodeLoad};
use crate::contact::bodies::{ContactSides, MemberParticles, MotionBounds};
use crate::contact::response::time_step::{self, NormalMotion, Touches};
use crate::contact::response::{ContactEnergy, Interaction};
use crate::parallel::BlockSum;
use crate::rigid::RigidBodies;
use crate::schedule::{Step, StepError};
use crate::symmetry::Map;

/// Layers of particles of a side with memory from the start.
const LAYERS: usize = 3;

/// Contact of the nodes of one body with the surface of another.
pub(in crate::contact) struct SurfaceContact {
    interaction: Interaction,
    pub sides: ContactSides,
    /// Acceleration of gravity, m/s2.
    gravity: f64,
    /// What is near the surface; of two rigid bodies once they have come near, which of many bodies most
    /// pairs never do.
    known: Option<Box<NearSurface>>,
}

/// The nodes near a surface, and the contacts among them.
pub(in crate::contact) struct NearSurface {
    nearby: Nearby,
    pub contacts: ActiveContacts<NodeTouch, NodePush, NearNodes>,
    /// The particles that touch.
    pub contact_nodes: ContactNodes,
    /// Data of the nodes near the surface for the time step.
    near: NearNodes,
    /// Forces of its springs on the rigid bodies, where dashpots need them.
    pub together: Option<CoupledResponse>,
}

/// The limit of an impact of two rigid bodies that are apart, s, as long as they approach no faster than at
/// `speed`, m/s, and are accelerated by no more than `gain`, m/s2.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct SlowImpact {
    pub speed: f64,
    pub gain: f64,
    pub limit: f64,
}

/// Speed and acceleration for which that limit is found, over those of the step.
const MARGIN: f64 = 1.25;

/// Responses of the nodes in contact in a step.
#[derive(Default)]
struct ToolResponses {
    energies: ContactEnergy,
    /// Squared frequency of an impact that may come, 1/s2.
    expected: f64,
    /// Number of all nodes.
    nodes: usize,
    /// Between the two bodies, m.
    gap: f64,
}

impl NearSurface {
    fn new(sides: &ContactSides) -> Self {
        let particles = sides.nodes.particles();
        let count = particles.map_or(0, |particles| particles.radius.len());
        let nearby = Nearby::new(count, particles.map_or(0.0, MemberParticles::max_radius));
        let capacity = particles.map_or(0, |particles| LAYERS * particles.on_a_side);
        let (mut contacts, mut contact_nodes) = (ActiveContacts::default(), ContactNodes::new(count));
        contacts.reserve(capacity);
        contact_nodes.reserve(capacity);
        Self { nearby, contacts, contact_nodes, near: NearNodes::default(), together: None }
    }

    fn is_idle(&self) -> bool {
        self.nearby.candidates().is_empty() && self.contacts.histories.is_empty() && self.together.is_none()
    }
}

impl SurfaceContact {
    /// Contact of the nodes of a body with the surface of another.
    pub fn new(interaction: Interaction, sides: ContactSides, gravity: f64) -> Self {
        let known = sides.nodes.particles().map(|_| Box::new(NearSurface::new(&sides)));
        Self { interaction, sides, gravity, known }
    }

    /// What is near the surface, once something has been.
    pub fn known(&self) -> Option<&NearSurface> {
        self.known.as_deref()
    }

    /// The same, to be changed.
    pub fn near(&mut self) -> &mut NearSurface {
        self.known.get_or_insert_with(|| Box::new(NearSurface::new(&self.sides)))
    }

    /// Whether nothing touches and no nodes are near the surface.
    pub fn is_idle(&self) -> bool {
        self.known().is_none_or(NearSurface::is_idle)
    }

    /// Has all nodes searched again.
    pub fn forget(&mut self) {
        self.near().nearby.forget();
    }

    /// Finds the nodes in contact, and adds the forces of their springs to the rigid bodies.
    pub fn find(&mut self, step: &Step<'_>, motion: [MotionBounds; 2]) -> Result<(), StepError> {
        let mut bodies = step.resources.get_mut::<RigidBodies>();
        let (speed, dt) = (MotionBounds::approach(motion, &Map::IDENTITY), step.clock.dt);
        self.near();
        let Self { interaction, sides, known: Some(known), .. } = self else { return Ok(()) };
        let NearSurface { nearby, contacts, contact_nodes, near, together } = &mut **known;
        let of_particles = sides.nodes.particles().is_some();
        (*near, *together) = sides.with(step.world, step.resources, &bodies, |nodes, tool| {
            let is_new = nearby.update(sides, nodes, tool, speed * dt, motion[0].stretch);
            if is_new && of_particles {
                contact_nodes.renew(nearby.candidates(), &[ContactEnd::First]);
            }
            if !of_particles {
                contacts.reserve(nodes.len());
            }
            let on = OnSurface { interaction, sides, nodes, tool, dt, together: &[] };
            let near = contacts
                .find(nearby.candidates(), |(node, _), near_nodes: &mut NearNodes, (): &mut ()| {
                    on.touching(node, near_nodes)
                });
            (near, on.act_together(contacts.met()))
        })?;
        if let Some(CoupledResponse { on_node, on_tool }) = together {
            let both = [(sides.first, &*on_node), (sides.second, &*on_tool)];
            for (id, springs) in both {
                let body = bodies.of_mut(id);
                body.into_iter().for_each(|body| body.contact_stiffness.add(springs));
            }
        }
        Ok(())
    }

    /// Energy of the springs of all active nodes, J.
    pub fn pressed(&mut self, step: &Step<'_>) -> Result<f64, StepError> {
        Ok(self.respond(step, 0.0, None)?.energies.stored)
    }

    /// Has the nodes that touch begin with that part of their overlaps.
    pub fn begin(&mut self, part: f64) {
        self.near().contacts.begin(|_, touch| touch.begun(part));
    }

    /// Computes the forces of all nodes that touch, where the bodies approach at `speed`, m/s.
    fn respond(
        &mut self,
        step: &Step<'_>,
        speed: f64,
        beside: Option<CoupledResponse>,
    ) -> Result<ToolResponses, StepError> {
        let (bodies, dt) = (step.resources.get::<RigidBodies>(), step.clock.dt);
        let Self { interaction, sides, known: Some(known), gravity } = self else {
            return Ok(ToolResponses::default());
        };
        let NearSurface { contacts, near, together, .. } = &mut **known;
        sides.with(step.world, step.resources, &bodies, |nodes, tool| {
            let together = together.map(|own| own.with_others(beside, nodes, tool));
            let together = together.as_ref().map_or(&[][..], |both| &both[..]);
            let on = OnSurface { interaction, sides, nodes, tool, dt, together };
            let energies = contacts.respond(
                nodes.len(),
                |(node, _), touch, before, energies| on.respond(node, touch, before, energies),
                |(node, _), history, energies| on.end(node, history, energies),
            );
            let (expected, gap) = (on.expected(near, speed, *gravity), sides.gap(nodes, tool));
            ToolResponses { energies, expected, nodes: nodes.len(), gap }
        })
    }

    /// Proposes the limits of two rigid bodies none of whose nodes is near the other one; gives the limit
    /// that an impact does not fall below for as long as they are little faster than now.
    pub fn limit_apart(
        &self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<SlowImpact, StepError> {
        let speed = MotionBounds::approach(motion, &Map::IDENTITY);
        let Self { interaction, sides, gravity, .. } = self;
        let (bodies, dt) = (step.resources.get::<RigidBodies>(), step.clock.dt);
        let (expected, gap, slow) = sides.with(step.world, step.resources, &bodies, |nodes, tool| {
            let on = OnSurface { interaction, sides, nodes, tool, dt, together: &[] };
            let near = NearNodes::default();
            let (speed_then, gain) = (MARGIN * speed, MARGIN * on.gain(*gravity));
            let impact = on.impact(&near, speed_then, gain);
            let limit = time_step::limit_of_rigid(impact, &NormalMotion::default(), dt);
            let slow = SlowImpact { speed: speed_then, gain, limit };
            (on.expected(&near, speed, *gravity), sides.gap(nodes, tool), slow)
        })?;
        let pair = [sides.first, sides.second];
        time_step::propose_rigid(step, pair, expected, NormalMotion::default());
        time_step::propose_approach(step, pair, motion[1].velocity - motion[0].velocity, gap);
        Ok(slow)
    }

    /// Computes the forces of all nodes that touch, and pushes the rigid bodies; `beside` are the contacts of
    /// the points of the other body on the surface of this one.
    pub fn run(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
        beside: Option<CoupledResponse>,
    ) -> Result<ContactEnergy, StepError> {
        let speed = MotionBounds::approach(motion, &Map::IDENTITY);
        let ToolResponses { energies, expected, nodes, gap } = self.respond(step, speed, beside)?;
        let resources = step.resources;
        let mut bodies = resources.get_mut::<RigidBodies>();
        let Self { interaction, sides, known: Some(known), .. } = self else { return Ok(energies) };
        let NearSurface { contacts, contact_nodes, near, .. } = &mut **known;
        let of_particles = sides.nodes.particles();
        let pushes = contacts.pushes();
        contact_nodes.add_up(contacts.numbers(), &|number, _| {
            let NodePush { force, arm, turning, stiffness, heat, .. } = pushes[number];
            NodeLoad {
                force,
                arm,
                beside: turning,
                stiffness: stiffness[0],
                heat: interaction.heat[0] * heat,
            }
        });
        let [particle, rigid] = push(sides, contacts.met(), pushes, nodes, &mut bodies);
        let squared = rigid + if of_particles.is_some() { contact_nodes.stiffest() } else { particle };
        let pair = [sides.first, sides.second];
        match of_particles {
            Some(particles) if expected == 0.0 => {
                let reach = 2.0 * near.distance.0.min(particles.min_radius());
                let touches = Touches { squared, stored: energies.stored, speed, reach };
                time_step::propose(step, pair, &touches)?;
            }
            _ => {
                time_step::propose_rigid(step, pair, squared.max(expected), near.landing);
                let velocity = motion[1].velocity - motion[0].velocity;
                time_step::propose_approach(step, pair, velocity, gap);
            }
        }
        Ok(energies)
    }
}
