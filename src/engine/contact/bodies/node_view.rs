//! Contact nodes: particles of a deformable body, or points of a rigid one.

use std::cmp::Ordering;

use glam::{DQuat, DVec3};

use super::crossing::Crossing;
use super::members::Members;
use super::node_pose::NodePose;
use super::shape::{ParticleShape, Proximity, on_surface};
use crate::rigid::{RigidBody, RigidNode, Round};
use crate::shapes::SurfacePoint;
use crate::solids::LocalMotion;

/// Which of the two contacts of a pair of rigid bodies, of the nodes of each with the surface of the other,
/// it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::contact) enum NodeTurn {
    /// There is no other.
    Alone,
    First,
    Second,
}

/// The nodes of a body in their current state.
pub(in crate::contact) enum NodeView<'a> {
    /// Particles.
    Particles(Members<'a>),
    /// The points of a rigid body.
    Rigid(&'a RigidBody),
}

impl NodeView<'_> {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        match self {
            Self::Particles(members) => members.len(),
            Self::Rigid(body) => body.nodes.list().len(),
        }
    }

    /// Whether a node takes part: a removed particle does not.
    pub fn is_there(&self, i: usize) -> bool {
        match self {
            Self::Particles(members) => members.is_there(i),
            Self::Rigid(_) => true,
        }
    }

    /// Whether nothing moves a node but conditions, such as a particle of a wall.
    pub fn is_held(&self, i: usize) -> bool {
        match self {
            Self::Particles(members) => members.is_held(i),
            Self::Rigid(_) => false,
        }
    }

    /// Whether the body may touch a surface of that outward normal with a node.
    pub fn faces(&self, i: usize, normal: DVec3) -> bool {
        match self {
            Self::Particles(_) => true,
            Self::Rigid(body) => body.nodes.list()[i].faces(body.state.rotation.inverse() * normal),
        }
    }

    /// Where a node is, m.
    pub fn position(&self, i: usize) -> DVec3 {
        match self {
            Self::Particles(members) => members.position(i),
            Self::Rigid(body) => body.place(body.nodes.list()[i].point),
        }
    }

    /// Radius of a node in the reference configuration, m.
    pub fn radius(&self, i: usize) -> f64 {
        match self {
            Self::Particles(members) => members.radius(i),
            Self::Rigid(body) => body.nodes.list()[i].radius(),
        }
    }

    /// How far from its place a node may touch, in the reference configuration, m.
    pub fn reach(&self, i: usize) -> f64 {
        match self {
            Self::Particles(members) => members.radius(i),
            Self::Rigid(body) => body.nodes.list()[i].reach(),
        }
    }

    /// Length that a node represents, m.
    pub fn size(&self, i: usize) -> f64 {
        match self {
            Self::Particles(members) => 2.0 * members.radius(i),
            Self::Rigid(body) => body.nodes.list()[i].size,
        }
    }

    /// How near a node is to a surface at a signed distance, m, with that outward normal.
    pub fn nearness(&self, i: usize, distance: f64, normal: DVec3) -> Proximity {
        let shape = match self {
            Self::Particles(members) => members.shape(i),
            Self::Rigid(body) => match body.nodes.list()[i].round {
                Round::Ball(radius) => ParticleShape { radius, gradient: None },
                Round::Point | Round::Rim(_) | Round::Ellipsoid(_) | Round::Edge(_) => {
                    ParticleShape { radius: 0.0, gradient: None }
                }
            },
        };
        on_surface(distance, normal, shape)
    }

    /// The nearest point of the surface of a tool to a node with its centre at `x`, m. None where a circle
    /// lies flat or is deepest below a ridge, and where an edge crosses none of the tool.
    pub fn nearest(&self, i: usize, x: DVec3, tool: &RigidBody) -> Option<SurfacePoint> {
        match self.node(i) {
            Some(node) => self.pose(x, tool).nearest(node, &*tool.surface),
            None => Some(tool.surface.closest(tool.reference(x))),
        }
    }

    /// The node of a rigid body.
    pub fn node(&self, i: usize) -> Option<&RigidNode> {
        match self {
            Self::Particles(_) => None,
            Self::Rigid(body) => Some(&body.nodes.list()[i]),
        }
    }

    /// How a tool sees a node with its centre at `x`, m.
    pub fn pose(&self, x: DVec3, tool: &RigidBody) -> NodePose {
        let rotation = match self {
            Self::Particles(_) => DQuat::IDENTITY,
            Self::Rigid(body) => body.state.rotation,
        };
        NodePose { x: tool.reference(x), turn: tool.state.rotation.inverse() * rotation }
    }

    /// Where the edge with its middle at `x` crosses one of a tool, if it comes so near that this counts, and
    /// if the node is an edge.
    pub fn crossing(&self, i: usize, x: DVec3, tool: &RigidBody) -> Option<Option<Crossing>> {
        self.node(i).and_then(|node| self.pose(x, tool).crossing(node, &*tool.surface))
    }

    /// Whether the lowest point of a ball is inside of the tool; a tool in the hole of a shell is near its
    /// centre, and does not touch its outside.
    pub fn reaches(&self, i: usize, x: DVec3, normal: DVec3, tool: &RigidBody) -> bool {
        let pose = self.pose(x, tool);
        let Some(arm) = self.node(i).and_then(|node| pose.lowest_of_ball(node, normal)) else { return true };
        tool.surface.closest(pose.x + arm).signed_distance < 0.0
    }

    /// Whether contact at a point of a tool is left to the nodes of the tool, because its round outline has
    /// circles as nodes, or is an ellipsoid. The circles of a ball lie in every plane, and take precedence
    /// over an ellipsoid, and that over the rims of a cylinder; of two equal ones the first contact keeps it,
    /// and the second one those at the ends of cylinders, which may meet the side of the other one anywhere.
    pub fn leaves_to(&self, i: usize, tool: &RigidBody, point: DVec3, turn: NodeTurn) -> bool {
        let Self::Rigid(body) = self else { return false };
        if turn == NodeTurn::Alone || !tool.nodes.is_round(point) {
            return false;
        }
        let node = &body.nodes.list()[i];
        match node.round {
            Round::Rim(_) | Round::Ellipsoid(_) => {
                match body.nodes.roundness().cmp(&tool.nodes.roundness()) {
                    Ordering::Equal => turn == NodeTurn::Second && !node.is_end(),
                    // The edge at the end of a cylinder is an edge.
                    Ordering::Less => tool.nodes.is_ball() || !node.is_end(),
                    Ordering::Greater => false,
                }
            }
            // The corner of a body may come between two rims.
            Round::Ball(_) | Round::Point | Round::Edge(_) => node.is_of_face() || tool.nodes.is_ball(),
        }
    }

    /// The place at which both bodies are pushed: where the material touches, `arm` beside the particle in
    /// the reference configuration. A sphere has no spin: it is pushed where it is, so that angular momentum
    /// is kept; a rigid body is pushed at the surface.
    pub fn place(&self, i: usize, position: DVec3, arm: DVec3, on_surface: impl FnOnce() -> DVec3) -> DVec3 {
        match self {
            Self::Particles(members) => position + members.carry(i, arm),
            Self::Rigid(_) => on_surface(),
        }
    }

    /// How the material of a node moves, if that is asked for.
    pub fn motion(&self, i: usize, moving: bool) -> NodeMotion<'_> {
        match self {
            Self::Particles(members) => NodeMotion::Particle(members.local_motion(i, moving)),
            Self::Rigid(body) => NodeMotion::Rigid(body),
        }
    }
}

/// How the material of a node moves.
pub(in crate::contact) enum NodeMotion<'a> {
    Particle(LocalMotion),
    Rigid(&'a RigidBody),
}

impl NodeMotion<'_> {
    /// Velocity at `place`, which is `arm` beside a particle, m/s.
    pub fn velocity(&self, arm: DVec3, place: DVec3) -> DVec3 {
        match self {
            Self::Particle(around) => around.velocity(arm),
            Self::Rigid(body) => body.velocity_at(place),
        }
    }

    /// Acceleration there by the forces of the last step, m/s2; those of a particle are in balance.
    pub fn acceleration(&self, place: DVec3) -> DVec3 {
        match self {
            Self::Particle(_) => DVec3::ZERO,
            Self::Rigid(body) => body.acceleration_at(place),
        }
    }

    /// Mean velocity of the material there in a step of `dt`, s, less `velocity`, m/s.
    pub fn lag(&self, place: DVec3, dt: f64) -> DVec3 {
        match self {
            Self::Particle(_) => DVec3::ZERO,
            Self::Rigid(body) => body.lag_at(place, dt),
        }
    }

    /// Angular velocity of what touches a tool, 1/s: the mean of two bodies; of the tool beside a particle.
    pub fn spin_with(&self, tool: &RigidBody) -> DVec3 {
        let of_tool = tool.state.angular_velocity;
        match self {
            Self::Particle(_) => of_tool,
            Self::Rigid(body) => 0.5 * (body.state.angular_velocity + of_tool),
        }
    }

    /// The inverse mass there along a direction, 1/kg.
    pub fn inverse_mass(&self, arm: DVec3, place: DVec3) -> impl Fn(DVec3) -> f64 {
        let mobility = match self {
            Self::Particle(around) => around.mobility(arm),
            Self::Rigid(_) => DVec3::ZERO,
        };
        move |n: DVec3| match self {
            Self::Particle(_) => mobility.dot(n * n),
            Self::Rigid(body) => body.inverse_mass_at(place, n),
        }
    }
}
