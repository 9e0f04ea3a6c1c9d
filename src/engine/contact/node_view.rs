//! Nodes that touch a surface: particles of a deformable body, or points of a rigid one.

use glam::DVec3;

use crate::rigid::RigidBody;
use crate::world::{Mobility, Position, Removed, Velocity};

/// The nodes of a body as they are now.
pub(super) enum NodeView<'a> {
    /// Particles.
    Particles {
        position: &'a [Position],
        velocity: &'a [Velocity],
        mobility: &'a [Mobility],
        removed: &'a [Removed],
        /// Radius of each, m.
        radius: &'a [f64],
    },
    /// The points of a rigid body.
    Rigid(&'a RigidBody),
}

impl NodeView<'_> {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        match self {
            Self::Particles { position, .. } => position.len(),
            Self::Rigid(body) => body.nodes.points.len(),
        }
    }

    /// Whether a node takes part: a removed particle does not.
    pub fn is_there(&self, i: usize) -> bool {
        match self {
            Self::Particles { removed, .. } => removed[i] == Removed::NO,
            Self::Rigid(_) => true,
        }
    }

    /// Where a node is, m.
    pub fn position(&self, i: usize) -> DVec3 {
        match self {
            Self::Particles { position, .. } => position[i].0,
            Self::Rigid(body) => body.place(body.nodes.points[i]),
        }
    }

    /// Radius of a node, m.
    pub fn radius(&self, i: usize) -> f64 {
        match self {
            Self::Particles { radius, .. } => radius[i],
            Self::Rigid(body) => body.nodes.radius,
        }
    }

    /// Length that a node stands for, m.
    pub fn size(&self, i: usize) -> f64 {
        match self {
            Self::Particles { radius, .. } => 2.0 * radius[i],
            Self::Rigid(body) => body.nodes.spacing,
        }
    }

    /// Least radius of all nodes, m.
    pub fn least_radius(&self) -> f64 {
        match self {
            Self::Particles { radius, .. } => radius.iter().copied().fold(f64::INFINITY, f64::min),
            Self::Rigid(body) => body.nodes.radius,
        }
    }

    /// The place at which both bodies are pushed. A particle has no spin: it is pushed where it is, so that angular momentum
    /// is kept; a rigid body is pushed at the surface.
    pub fn place(&self, position: DVec3, on_surface: impl FnOnce() -> DVec3) -> DVec3 {
        match self {
            Self::Particles { .. } => position,
            Self::Rigid(_) => on_surface(),
        }
    }

    /// Velocity of the material of a node at `place`, m/s.
    pub fn velocity(&self, i: usize, place: DVec3) -> DVec3 {
        match self {
            Self::Particles { velocity, .. } => velocity[i].0,
            Self::Rigid(body) => body.velocity_at(place),
        }
    }

    /// Inverse mass of a node at `place` along a direction, 1/kg.
    pub fn inverse_mass(&self, i: usize, place: DVec3, direction: DVec3) -> f64 {
        match self {
            Self::Particles { mobility, .. } => direction.dot(mobility[i].0 * direction),
            Self::Rigid(body) => body.inverse_mass_at(place, direction),
        }
    }
}
