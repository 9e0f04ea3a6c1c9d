//! Shapes of the nodes of rigid bodies.

use glam::DVec3;

use super::ellipsoid::RigidEllipsoid;
use super::rim::Rim;

/// Shape of a node.
#[derive(Clone, Copy, Debug)]
pub enum Round {
    /// The point itself.
    Point,
    /// The whole body, a sphere or disc of that radius about it, m.
    Ball(f64),
    /// The lowest point of a circle about it.
    Rim(Rim),
    /// The lowest point of an ellipsoid about it.
    Ellipsoid(RigidEllipsoid),
    /// Where a straight edge, whose middle it is, crosses an edge of another body: from there to its end, m.
    Edge(DVec3),
}
