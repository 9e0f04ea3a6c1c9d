//! A node of a rigid body as another one sees it.

use glam::{DQuat, DVec3};

use super::circle::CircleBeside;
use super::crossing::Crossing;
use super::ellipsoid::EllipsoidBeside;
use crate::rigid::{RigidNode, Round};
use crate::shapes::{Surface, SurfacePoint};

/// Where a node of a rigid body is, in the reference configuration of another one.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct NodePose {
    /// Its centre, m.
    pub x: DVec3,
    /// Rotation from the reference configuration of its body.
    pub turn: DQuat,
}

impl NodePose {
    /// The nearest point of a surface. For a circle or an ellipsoid it is that to its deepest point, and for
    /// a ball to its lowest one over the plane that is tangential to the surface at the point nearest to the
    /// centre. None where a circle lies flat, where a circle or an ellipsoid is deepest below a ridge, and
    /// where an edge crosses none of the surface.
    pub fn nearest(&self, node: &RigidNode, surface: &dyn Surface) -> Option<SurfacePoint> {
        if let Some(crossing) = self.crossing(node, surface) {
            return Some(crossing?.at);
        }
        let center = self.x;
        if let Round::Rim(rim) = node.round
            && !rim.is_ball()
        {
            return CircleBeside { surface, center, rim: rim.turned(self.turn), size: node.size }.deepest();
        }
        if let Round::Ellipsoid(ellipsoid) = node.round {
            return EllipsoidBeside { surface, center, ellipsoid: ellipsoid.turned(self.turn) }.deepest();
        }
        let nearest = surface.closest(center);
        let Some(arm) = self.lowest_of_ball(node, nearest.normal) else { return Some(nearest) };
        let signed_distance = nearest.signed_distance + arm.dot(nearest.normal);
        let point = center + arm - nearest.normal * signed_distance;
        Some(SurfacePoint { point, signed_distance, ..nearest })
    }

    /// Where an edge crosses one of a surface, if it comes so near that this counts, and if the node is an
    /// edge.
    pub fn crossing(&self, node: &RigidNode, surface: &dyn Surface) -> Option<Option<Crossing>> {
        let Round::Edge(half) = node.round else { return None };
        let half = self.turn * half;
        Some(Crossing::of(surface, [self.x - half, self.x + half], node.size))
    }

    /// From the centre of a ball to its lowest point over a plane of that normal, if the node is one.
    pub fn lowest_of_ball(&self, node: &RigidNode, normal: DVec3) -> Option<DVec3> {
        let Round::Rim(rim) = node.round else { return None };
        if rim.is_ball() { rim.lowest(normal) } else { None }
    }

    /// The same, moved by a way, m, and turned about its centre by a rotation vector.
    pub fn moved(&self, way: DVec3, turn: DVec3) -> Self {
        Self { x: self.x + way, turn: DQuat::from_scaled_axis(turn) * self.turn }
    }
}
