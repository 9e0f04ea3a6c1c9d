//! The weight of a node of a rigid body on the surface of another.
//!
//! All points of a face or of an edge that lies on a face are in contact. As a body slides over the points of
//! another one, they enter below its face at an edge, already at the depth of the overlap: a spring that
//! began there would have spurious energy, and a frictionless box that bounced on another one gained a
//! quarter of its energy in two seconds. So the energy of a point x is `w u(d)`, where w is the difference of
//! its depths below the two nearest faces, over a length D:
//!
//! ```text
//! w = (s(x) - s(x - D n)) / D,      D = 0.4 of the length that the point stands for
//! ```
//!
//! with the signed distance s and the normal n at x. It is zero below the ridge of a right edge, where edges
//! that cross take over; below a ridge at which the normal turns by less, it is the cosine of that angle from
//! both sides. The deepest point of a circle has the same weight. A face that stands across the other one has
//! none, and all of it where it is inclined to that by less than 66 degrees; edges that cross have that of
//! their [`Crossing`](crate::contact::bodies::Crossing).
//!
//! Points of edges and corners of a body come on top of those of its faces, which stand for their whole area
//! already: while a face lies on another one they have a fifth of their weight, and all of it when the body
//! stands on the edge.
//!
//! All of these change as the bodies move and turn: where a surface is round its normal turns, and the
//! deepest point of a circle moves along it. The derivatives are central differences, so that the force is
//! the gradient of the energy whatever the weight follows.

use glam::DVec3;

use crate::contact::bodies::{NodePose, RAMP, share_of_slope};
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
/// A share that is one but for round-off.
const WHOLE_FROM: f64 = 1.0 - 1e-12;

/// The share w of a node, its gradient, 1/m, and its derivative with a rotation of the body of the node
/// against the surface, about the centre of the node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    pub share: f64,
    gradient: DVec3,
    turning: DVec3,
}

impl Share {
    /// For nodes that always count.
    pub const WHOLE: Self = Self { share: 1.0, gradient: DVec3::ZERO, turning: DVec3::ZERO };

    /// For a node of a rigid body that is in that pose beside `tool`.
    pub fn of_node(node: &RigidNode, pose: &NodePose, tool: &RigidBody) -> Self {
        let weight = NodeWeight { node, surface: &*tool.surface };
        let share = weight.at(pose);
        // A clamped weight does not change.
        if share == 0.0 || share > WHOLE_FROM {
            return Self { share, ..Self::default() };
        }
        let slope = |step: f64, of: &dyn Fn(DVec3) -> f64| {
            let along = |axis: DVec3| (of(step * axis) - of(-step * axis)) / (2.0 * step);
            tool.state.rotation * DVec3::from_array(DVec3::AXES.map(along))
        };
        Self {
            share,
            gradient: slope(STEP * node.size, &|way| weight.at(&pose.moved(way, DVec3::ZERO))),
            turning: slope(STEP, &|turn| weight.at(&pose.moved(DVec3::ZERO, turn))),
        }
    }

    /// u times the two derivatives, N and N m, where the energy w u of a spring is given, J.
    pub fn derivatives(&self, energy: f64) -> [DVec3; 2] {
        if self.share == 0.0 {
            return [DVec3::ZERO; 2];
        }
        [self.gradient, self.turning].map(|derivative| energy / self.share * derivative)
    }
}

/// The weight of a node on a surface.
struct NodeWeight<'a> {
    node: &'a RigidNode,
    surface: &'a dyn Surface,
}

impl NodeWeight<'_> {
    /// In a pose.
    fn at(&self, pose: &NodePose) -> f64 {
        if let Some(crossing) = pose.crossing(self.node, self.surface) {
            return crossing.map_or(0.0, |crossing| crossing.share);
        }
        let Some(nearest) = pose.nearest(self.node, self.surface) else { return 0.0 };
        let normal = nearest.normal;
        match (self.node.feature, self.node.round) {
            (Feature::Face(own), _) => {
                share_of_slope(-(pose.turn * own).dot(normal)) * self.beside_ridge(&nearest)
            }
            (Feature::Edge(edge), _) => {
                // An edge that stands on the face is in contact at its ends and crossings.
                let lying = 1.0 - share_of_slope((pose.turn * edge).dot(normal).abs());
                lying * self.beside_ridge(&nearest) * self.beside_faces(pose, normal)
            }
            (Feature::Corner, Round::Rim(rim)) if !rim.is_ball() => {
                self.beside_ridge(&nearest) * self.beside_faces(pose, normal)
            }
            (Feature::Corner, _) => self.beside_faces(pose, normal),
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
