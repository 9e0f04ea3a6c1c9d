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
//! both sides, and what depends on the normal is a mean of both faces. The deepest point of a circle has the
//! same weight. A face that stands across the other one has none, and all of it where it is inclined to that
//! by less than 66 degrees; edges that cross have that of their crossing.
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

    /// Whether the node does not count.
    pub fn is_zero(&self) -> bool {
        self.share == 0.0
    }

    /// u times the two derivatives, N and N m, where the energy w u of a spring is given, J.
    pub fn derivatives(&self, energy: f64) -> [DVec3; 2] {
        if self.is_zero() {
            return [DVec3::ZERO; 2];
        }
        [self.gradient, self.turning].map(|derivative| energy / self.share * derivative)
    }
}

/// A point beside the ridge between two faces, such as the deepest one of a circle.
struct Ridge {
    /// Difference of the depths below both, over a length: the weight of the point.
    share: f64,
    /// Cosine of the angle between the normals: the share where both faces are as near.
    cosine: f64,
    /// Normals of the nearest face and of the other one.
    normals: [DVec3; 2],
}

impl Ridge {
    /// A mean of a function of the normal: half and half where both faces are as near, that of the nearest
    /// one from a share of `cosine + range` on.
    fn mean(&self, range: f64, of: impl Fn(DVec3) -> f64) -> f64 {
        let [nearest, other] = self.normals;
        let beyond = self.share - self.cosine;
        if beyond >= range {
            return of(nearest);
        }
        let of_nearest = 0.5 * (1.0 + (beyond / range).max(0.0));
        of_nearest * of(nearest) + (1.0 - of_nearest) * of(other)
    }

    /// The mean over all of the length.
    fn wide_mean(&self, of: impl Fn(DVec3) -> f64) -> f64 {
        self.mean(1.0 - self.cosine, of)
    }

    /// The mean, times the share: its range is the narrower the less is there at the ridge to be evened out.
    fn shared(&self, of: impl Fn(DVec3) -> f64) -> f64 {
        self.share * self.mean(self.cosine.min(1.0 - self.cosine), of)
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
        let ridge = self.beside_ridge(&nearest);
        match (self.node.feature, self.node.round) {
            (Feature::Face(own), _) => {
                let own = pose.turn * own;
                ridge.shared(|normal| share_of_slope(-own.dot(normal)))
            }
            (Feature::Edge(edge), _) => {
                // An edge that stands on the face is in contact at its ends and crossings.
                let edge = pose.turn * edge;
                let lying = |normal: DVec3| 1.0 - share_of_slope(edge.dot(normal).abs());
                ridge.shared(|normal| lying(normal) * self.beside_faces(pose, normal))
            }
            (Feature::Corner, Round::Ellipsoid(_)) => ridge.shared(|normal| self.beside_faces(pose, normal)),
            (Feature::Corner, Round::Rim(rim)) if !rim.is_ball() => {
                ridge.shared(|normal| self.beside_faces(pose, normal))
            }
            (Feature::Corner, _) => ridge.wide_mean(|normal| self.beside_faces(pose, normal)),
        }
    }

    fn beside_ridge(&self, nearest: &SurfacePoint) -> Ridge {
        let SurfacePoint { point, normal, signed_distance } = *nearest;
        let depth = RAMP * self.node.size;
        let below = self.surface.closest(point + (signed_distance - depth) * normal);
        Ridge {
            share: ((signed_distance - below.signed_distance) / depth).clamp(0.0, 1.0),
            cosine: normal.dot(below.normal).clamp(0.0, 1.0),
            normals: [normal, below.normal],
        }
    }

    /// Of a point where faces end, on a surface of that normal.
    fn beside_faces(&self, pose: &NodePose, normal: DVec3) -> f64 {
        let cosine =
            self.node.ending.map(|own| -(pose.turn * own).dot(normal)).into_iter().fold(0.0, f64::max);
        ON_FACE + (1.0 - ON_FACE) * ((1.0 - cosine) / STANDING).clamp(0.0, 1.0)
    }
}
