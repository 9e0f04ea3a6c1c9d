//! The weight of a node: of a point near the edge of the face that it touches, and of an edge that crosses
//! another one.
//!
//! All points of a face or of an edge that lies on a face are in contact. As a body slides over the points of
//! another one, they enter below its face at an edge, already at the depth of the overlap: a spring that
//! began there would have spurious energy, and a frictionless box that bounced on another one gained a
//! quarter of its energy in two seconds. So the energy of such a point is `w u(d)`, where w grows from zero
//! at the edge of the other face to one at a distance D from it,
//!
//! ```text
//! w = -s(p - D n) / D,      D = 0.4 of the length that the point stands for
//! ```
//!
//! with the nearest point p of the surface, its normal n, and the signed distance s. Along the face the force
//! is `-u grad w`, a share d/(2 D) of the normal force at most. A point x of an edge has the difference of
//! the depths of x below the two nearest faces, over D:
//!
//! ```text
//! w = (s(x) - s(x - D n)) / D
//! ```
//!
//! which is zero below the ridge between them, where the edge itself takes over.
//!
//! Points of edges and corners of a body come on top of those of its faces, which stand for their whole area
//! already: while a face lies on another one they have a fifth of their weight, and all of it when the body
//! stands on the edge.

use glam::DVec3;

use crate::contact::bodies::{Crossing, NodePose, RAMP, share_of_slope};
use crate::rigid::{Feature, RigidBody, RigidNode, Round};
use crate::shapes::{Surface, SurfacePoint};

/// Weight of a point of an edge or a corner of a face that lies on another one: the points of the face
/// already stand for its area up to there. It is not zero, so that a body that begins to rock turns about its
/// edge.
const ON_FACE: f64 = 0.2;
/// One less the cosine of the angle between two faces from which on their edge counts whole: below 6 degrees
/// points of the other surface do not touch what is beyond the edge (`RigidNode::faces`).
const STANDING: f64 = 0.005;

/// Steps of the differences from which derivatives follow, over the size of a node, and rad.
const STEP: f64 = 1e-6;

/// The share w of a node, its gradient, 1/m, and its derivative with a rotation of the body of the node
/// against the surface about the centre of the node, or the crossing of an edge.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    pub share: f64,
    gradient: DVec3,
    turning: DVec3,
}

impl Share {
    /// For nodes that always count.
    pub const WHOLE: Self = Self { share: 1.0, gradient: DVec3::ZERO, turning: DVec3::ZERO };

    /// For a node of a rigid body, whose nearest point of the surface of `tool` is given.
    pub fn of_node(node: &RigidNode, pose: &NodePose, nearest: &SurfacePoint, tool: &RigidBody) -> Self {
        let weight = Weight { node, surface: &*tool.surface };
        let share = weight.at(pose, nearest);
        let moved = |way: DVec3, turn: DVec3| {
            let pose = pose.moved(way, turn);
            pose.nearest(node, weight.surface).map_or(0.0, |nearest| weight.at(&pose, &nearest))
        };
        let slope = |size: f64, of: &dyn Fn(DVec3) -> f64| {
            let along = |axis: DVec3| (of(size * axis) - of(-size * axis)) / (2.0 * size);
            tool.state.rotation * DVec3::from_array(DVec3::AXES.map(along))
        };
        Self {
            share,
            gradient: slope(STEP * node.size, &|way| moved(way, DVec3::ZERO)),
            turning: slope(STEP, &|turn| moved(DVec3::ZERO, turn)),
        }
    }

    /// For an edge.
    pub fn of_crossing(crossing: &Crossing, tool: &RigidBody) -> Self {
        let [gradient, turning] = [crossing.gradient, crossing.turning].map(|of| tool.state.rotation * of);
        Self { share: crossing.share, gradient, turning }
    }

    /// u times the two derivatives, N and N m, where the energy w u of a spring is given, J.
    pub fn derivatives(&self, energy: f64) -> [DVec3; 2] {
        let of = |derivative: DVec3| {
            if derivative == DVec3::ZERO { DVec3::ZERO } else { energy / self.share * derivative }
        };
        [of(self.gradient), of(self.turning)]
    }
}

/// The weight of a node on a surface.
struct Weight<'a> {
    node: &'a RigidNode,
    surface: &'a dyn Surface,
}

impl Weight<'_> {
    /// In a pose, for which the nearest point of the surface is given.
    fn at(&self, pose: &NodePose, nearest: &SurfacePoint) -> f64 {
        match (self.node.feature, self.node.round) {
            (Feature::Face(own), _) => {
                share_of_slope(-(pose.turn * own), nearest.normal).0 * self.beside_ridge(nearest)
            }
            (Feature::Edge(edge), _) => {
                // An edge that stands on the face is in contact at its ends and crossings.
                let edge = pose.turn * edge;
                let rising = if nearest.normal.dot(edge) < 0.0 { -edge } else { edge };
                let lying = 1.0 - share_of_slope(rising, nearest.normal).0;
                lying * self.beside_ridge(nearest) * self.beside_faces(pose, nearest.normal)
            }
            (Feature::Corner, Round::Rim(rim)) if !rim.is_ball() => {
                self.beside_ridge(nearest) * self.beside_faces(pose, nearest.normal)
            }
            (Feature::Corner, _) => self.beside_faces(pose, nearest.normal),
        }
    }

    /// Of a point that may be below the ridge between two faces, such as the deepest one of a circle: zero
    /// where another face is as near.
    fn beside_ridge(&self, nearest: &SurfacePoint) -> f64 {
        let SurfacePoint { point, normal, signed_distance } = *nearest;
        let depth = RAMP * self.node.size;
        let below = self.surface.closest(point + (signed_distance - depth) * normal);
        ((signed_distance - below.signed_distance) / depth).clamp(0.0, 1.0)
    }

    /// Of a point where faces end, on a surface of that normal.
    fn beside_faces(&self, pose: &NodePose, normal: DVec3) -> f64 {
        let cosine =
            self.node.ending.map(|own| -(pose.turn * own).dot(normal)).into_iter().fold(0.0, f64::max);
        ON_FACE + (1.0 - ON_FACE) * ((1.0 - cosine) / STANDING).clamp(0.0, 1.0)
    }
}
