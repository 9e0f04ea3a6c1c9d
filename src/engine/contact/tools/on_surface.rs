//! Nodes of one body on the surface of another in a step: which of them touch, and their forces.

use glam::DVec3;

use super::nearby::NEAR;
use super::reaction::NodePush;
use super::share::Share;
use super::together::{ContactSite, CoupledResponse};
use crate::contact::active::MinimumLength;
use crate::contact::bodies::{ContactSides, NodeMotion, NodeView, Proximity};
use crate::contact::laws::Touch;
use crate::contact::response::time_step::NormalMotion;
use crate::contact::response::{ContactEnergy, ContactState, History, Interaction, Losses, PairKey};
use crate::parallel::BlockSum;
use crate::rigid::RigidBody;
use crate::world::sum_by_row;

/// A node that touches.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct NodeTouch {
    /// The image of the node that is near the surface, m, and from there to the node: zero, or a period.
    x: DVec3,
    shift: DVec3,
    /// Nearest point of the surface, m.
    point: DVec3,
    near: Proximity,
    share: Share,
}

impl NodeTouch {
    /// It begins with that part of its overlap.
    pub fn begun(&self, part: f64) -> History {
        History::begun(self.near.overlap, part)
    }
}

/// Data of the nodes near the surface for the time step.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct NearNodes {
    /// Minimum distance of the surface and the centre of a particle that just touches it, m.
    pub distance: MinimumLength,
    /// The first particle near the surface that nothing moves but conditions.
    pub held: Option<usize>,
    /// How many nodes near it have no mass of their own: points of a rigid body, and such particles.
    pub massless: usize,
    /// Their normal motion.
    pub landing: NormalMotion,
}

impl BlockSum for NearNodes {
    fn add(&mut self, next: &Self) {
        self.distance.add(&next.distance);
        self.held = self.held.or(next.held);
        self.massless += next.massless;
        self.landing.add(&next.landing);
    }
}

/// The nodes of one body, the surface of another, and how they act on each other in a step.
pub(super) struct OnSurface<'a> {
    pub interaction: &'a Interaction,
    pub sides: &'a ContactSides,
    pub nodes: &'a NodeView<'a>,
    pub tool: &'a RigidBody,
    /// Length of the step, s.
    pub dt: f64,
    /// Forces of the contacts of the step on the rigid bodies, those between the two and all of them, if
    /// dashpots need them.
    pub together: &'a [CoupledResponse],
}

impl OnSurface<'_> {
    /// Contact of a node, if it has one. Adds its data for the time step.
    #[inline(always)]
    pub fn touching(&self, node: u32, near_nodes: &mut NearNodes) -> Option<NodeTouch> {
        let Self { nodes, tool, .. } = self;
        let i = node as usize;
        let own_place = nodes.position(i);
        let center = self.sides.near(own_place, tool);
        let (crossing, nearest) = match nodes.crossing(i, center, tool) {
            Some(crossing) => crossing.map(|crossing| (Some(crossing), crossing.at))?,
            None => (None, nodes.nearest(i, center, tool)?),
        };
        let normal = tool.state.rotation * nearest.normal;
        let mut near = nodes.nearness(i, nearest.signed_distance, normal);
        if let Some(crossing) = &crossing {
            near.scale = crossing.scale;
        }
        let is_far = near.overlap <= -NEAR * near.scale * nodes.size(i);
        if is_far || !nodes.is_there(i) || nodes.leaves_to(i, tool, nearest.point, self.sides.turn) {
            return None;
        }
        let touches = near.overlap > 0.0 && nodes.reaches(i, center, nearest.normal, tool);
        let share = match nodes.node(i) {
            Some(node) if touches => Share::of_node(node, &nodes.pose(center, tool), tool),
            _ => Share::WHOLE,
        };
        if !nodes.faces(i, normal) && (!touches || share.is_zero()) {
            return None;
        }
        let held = nodes.is_held(i).then_some(i);
        let massless = usize::from(held.is_some() || matches!(nodes, NodeView::Rigid(_)));
        let landing = self.landing(i, held.is_some(), [nearest.point, own_place - center], &near);
        near_nodes.add(&NearNodes {
            distance: MinimumLength(nodes.radius(i) / near.scale),
            held,
            massless,
            landing,
        });
        // Where the body of the node has it, a period away from the image that touches.
        let shift = own_place - center;
        touches.then_some(NodeTouch { x: center, shift, point: nearest.point, near, share })
    }

    /// How a node that nothing moves but the body that it is a point of, or conditions, moves against the
    /// surface, of which a point of the reference configuration is nearest to it; `shift` is the way to the
    /// image of the node.
    fn landing(&self, i: usize, held: bool, [point, shift]: [DVec3; 2], near: &Proximity) -> NormalMotion {
        let Self { nodes, tool, dt, .. } = self;
        if matches!(nodes, NodeView::Particles(_)) && !held {
            return NormalMotion::UNKNOWN;
        }
        let (motion, place) = (nodes.motion(i, true), tool.place(point));
        let velocity = motion.velocity(DVec3::ZERO, place + shift) - tool.velocity_at(place);
        let acceleration = motion.acceleration(place + shift) - tool.acceleration_at(place);
        let [speed, change] = [velocity, acceleration].map(|of| of.dot(near.normal).abs());
        NormalMotion::of(near.overlap, speed, change, *dt)
    }

    /// The force of a node that touches, with its history.
    #[inline(always)]
    pub fn respond(
        &self,
        node: u32,
        touch: &NodeTouch,
        before: &History,
        energies: &mut ContactEnergy,
    ) -> (History, NodePush) {
        let Self { interaction, nodes, tool, dt, .. } = self;
        let i = node as usize;
        let motion = nodes.motion(i, !interaction.is_elastic() || before.is_none());
        let mut losses = Losses::default();
        self.add_work_before(node, &motion, before, &mut losses);
        let NodeTouch { x, shift, point, near, share } = *touch;
        let (arm, normal) = (near.arms[0], near.normal);
        let place = nodes.place(i, x, arm, || tool.place(point));
        let state = ContactState {
            touch: self.touch(i, near.overlap),
            normal,
            scale: near.scale,
            area: share.share,
            arms: near.arms,
            velocity: motion.velocity(arm, place + shift) - tool.velocity_at(place),
            lag: motion.lag(place + shift, *dt) - tool.lag_at(place, *dt),
            spin: motion.spin_with(tool).dot(normal),
            acceleration: motion.acceleration(place + shift) - tool.acceleration_at(place),
        };
        let own = motion.inverse_mass(arm, place + shift);
        let alone = |n: DVec3| own(n) + tool.inverse_mass_at(place, n);
        let among = self.together.iter().fold(1.0, |most: f64, together| {
            most.max(together.share(&self.spot(i, touch), nodes, tool, alone(normal), own(normal)))
        });
        let inverse_mass = |n: DVec3| among * alone(n);
        let response = interaction.respond(&state, inverse_mass, *dt, before);
        losses.add_work(1.0, &response.history, state.velocity, *dt);
        losses.keep(1.0, before, &response.history);
        energies.losses.add(&losses);
        energies.stored += response.spring.energy + response.history.energy();
        energies.ahead += 0.5 * dt * response.force.dot(state.velocity);
        let turning = if arm == DVec3::ZERO {
            DVec3::ZERO
        } else {
            -response.spring.force * turn_of_normal(tool, x, normal, x - place)
        };
        let stiffness = [own(normal), tool.inverse_mass_at(place, normal)];
        let stiffness = stiffness.map(|inverse_mass| response.spring.stiffness * inverse_mass);
        // u grad w, with the energy w u of the spring.
        let [along, couple] = share.derivatives(response.spring.energy);
        let (force, heat) = (response.force - along, losses.friction);
        // The gradient is that with the centre of the node, and the force acts at its place.
        let couple = couple + (x - place).cross(along);
        (
            response.history,
            NodePush { arm, place, shift, force, couple: -couple, center: x, turning, heat, stiffness },
        )
    }

    /// Forces of all contacts of the step on rigid bodies, where dashpots need them.
    pub fn act_together(&self, met: &[(PairKey, NodeTouch)]) -> Option<CoupledResponse> {
        let Self { interaction, nodes, tool, .. } = self;
        let shares_a_mass = matches!(nodes, NodeView::Rigid(_)) || !tool.is_driven();
        (interaction.damping_ratio > 0.0 && shares_a_mass).then(|| {
            let node = |k: usize| met[k].0.0 as usize;
            let of = |k: usize| CoupledResponse::of(&self.spot(node(k), &met[k].1), nodes, tool);
            sum_by_row(nodes.len(), met.len(), &node, &of)
        })
    }

    fn spot(&self, i: usize, touch: &NodeTouch) -> ContactSite {
        let Self { interaction, nodes, tool, .. } = self;
        let NodeTouch { x, shift, point, near, share } = *touch;
        let place = nodes.place(i, x, near.arms[0], || tool.place(point));
        let spring = interaction.law.at(&self.touch(i, near.overlap)).along(near.scale);
        ContactSite { place, shift, normal: near.normal, stiffness: share.share * spring.stiffness }
    }

    /// Takes in the energy of a contact that has ended.
    pub fn end(&self, node: u32, history: &History, energies: &mut ContactEnergy) {
        let Self { interaction, sides, nodes, tool, dt, .. } = self;
        let i = node as usize;
        let motion = nodes.motion(i, !interaction.is_elastic());
        self.add_work_before(node, &motion, history, &mut energies.losses);
        energies.losses.keep(1.0, history, &History::default());
        if !nodes.is_there(i) {
            let x = sides.near(nodes.position(i), tool);
            let nearest = tool.surface.closest(tool.reference(x));
            let state = ContactState {
                touch: self.touch(i, history.overlap),
                normal: tool.state.rotation * nearest.normal,
                scale: 1.0,
                area: 1.0,
                arms: history.arms,
                velocity: motion.velocity(DVec3::ZERO, x) - tool.velocity_at(x),
                lag: DVec3::ZERO,
                spin: 0.0,
                acceleration: DVec3::ZERO,
            };
            energies.removed += interaction.held(&state, *dt, history);
        }
    }

    /// Adds the work of the forces of the last step on the motion of this one, where they act: at the node
    /// and, for a particle, `arm` beside it.
    #[inline(always)]
    fn add_work_before(&self, node: u32, motion: &NodeMotion<'_>, history: &History, losses: &mut Losses) {
        if history.is_elastic() {
            return;
        }
        let Self { sides, nodes, tool, .. } = self;
        let (i, arm) = (node as usize, history.arms[0]);
        let own_place = nodes.position(i);
        let center = sides.near(own_place, tool);
        let surface = || {
            let nearest = nodes.nearest(i, center, tool);
            tool.place(nearest.map_or(tool.reference(center), |nearest| nearest.point))
        };
        let place = nodes.place(i, center, arm, surface);
        let own = place + (own_place - center);
        let velocity = motion.velocity(arm, own) - tool.velocity_at(place);
        let lag = motion.lag(own, self.dt) - tool.lag_at(place, self.dt);
        // With the arms of the beginning of the step, where that force acted.
        losses.add_work(1.0, history, velocity + 2.0 * lag, self.dt);
    }

    /// The squared frequency of the impact that a rigid body may make at `speed` on another one or on
    /// particles that do not give way, of which one is held, 1/s2: a spring that gets stiffer with depth, or
    /// has no mass that would limit the step by itself, must not come as a surprise. All nodes that are near
    /// may touch at once.
    pub fn expected(&self, near: &NearNodes, speed: f64, gravity: f64) -> f64 {
        self.impact(near, speed, self.gain(gravity))
    }

    /// Acceleration with which both may fall towards each other, m/s2.
    pub fn gain(&self, gravity: f64) -> f64 {
        let own = if let NodeView::Rigid(body) = self.nodes { body.last_acceleration() } else { 0.0 };
        gravity.max(own).max(self.tool.last_acceleration())
    }

    /// The same for an acceleration `gain`, m/s2; it grows with speed and acceleration.
    pub fn impact(&self, near: &NearNodes, speed: f64, gain: f64) -> f64 {
        let Self { interaction, nodes, tool, .. } = self;
        let count = near.massless.max(1) as f64;
        let inverse = |body: &RigidBody| if body.is_driven() { 0.0 } else { 1.0 / body.mass };
        let (node, inverse_mass) = match (nodes, near.held) {
            (NodeView::Rigid(body), _) => (0, inverse(body) + inverse(tool)),
            (NodeView::Particles(_), Some(node)) => (node, inverse(tool)),
            (NodeView::Particles(_), None) => return 0.0,
        };
        if inverse_mass == 0.0 {
            return 0.0;
        }
        let touch = self.touch(node, 0.0);
        // A body at rest may fall: what it gains over the length of a node counts as its speed.
        let speed = speed + (2.0 * gain * touch.length).sqrt();
        let inverse_mass = count * inverse_mass;
        interaction.law.stiffness_of_impact(&touch, 1.0 / inverse_mass, speed) * inverse_mass
    }

    fn touch(&self, i: usize, overlap: f64) -> Touch {
        let length = self.nodes.size(i);
        let own = if self.nodes.radius(i) > 0.0 { self.nodes.radius(i) } else { 0.5 * length };
        let radius = self.tool.nodes.sphere().map_or(own, |other| own * other / (own + other));
        let depth = if matches!(self.nodes, NodeView::Particles(_)) { own } else { f64::INFINITY };
        Touch { overlap, radius, length, depth }
    }
}

/// How the normal of a surface turns as a particle moves along the part of `p` that is across it: on curved
/// surfaces and beside edges the overlap depends on that, because the reach of the particle does. Half-way
/// inside a body normals jump, and there is no such thing.
fn turn_of_normal(tool: &RigidBody, x: DVec3, normal: DVec3, p: DVec3) -> DVec3 {
    const STEP: f64 = 1e-4;
    let across = p - p.dot(normal) * normal;
    let at = |s: f64| tool.surface.closest(tool.reference(x + s * across)).normal;
    let change = at(STEP) - at(-STEP);
    if change.length_squared() < 0.01 { tool.state.rotation * change / (2.0 * STEP) } else { DVec3::ZERO }
}
