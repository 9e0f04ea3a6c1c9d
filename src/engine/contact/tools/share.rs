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

use crate::contact::bodies::{Crossing, RAMP, growing, share_of_slope};
use crate::rigid::RigidBody;
use crate::shapes::SurfacePoint;

/// Weight of a point of an edge or a corner of a face that lies on another one: the points of the face
/// already stand for its area up to there. It is not zero, so that a body that begins to rock turns about its
/// edge.
const ON_FACE: f64 = 0.2;
/// One less the cosine of the angle between two faces from which on their edge counts whole: below 6 degrees
/// points of the other surface do not touch what is beyond the edge (`RigidNode::faces`).
const STANDING: f64 = 0.005;

/// The share w of a node, its gradient, 1/m, and its derivative with a rotation of the body of the node
/// against the surface.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    pub share: f64,
    gradient: DVec3,
    turning: DVec3,
}

impl Share {
    /// For nodes that always count.
    pub const WHOLE: Self = Self { share: 1.0, gradient: DVec3::ZERO, turning: DVec3::ZERO };

    /// For a point that represents a length, m, and is nearest to that point of the surface of `tool`, in the
    /// reference configuration.
    pub fn on_face(nearest: &SurfacePoint, length: f64, tool: &RigidBody) -> Self {
        let depth = RAMP * length;
        let below = tool.surface.closest(nearest.point - depth * nearest.normal);
        let share = (-below.signed_distance / depth).clamp(0.0, 1.0);
        let across = below.normal - nearest.normal * nearest.normal.dot(below.normal);
        let gradient = if share > 0.0 { tool.state.rotation * across / -depth } else { DVec3::ZERO };
        Self { share, gradient, turning: DVec3::ZERO }
    }

    /// For a point that represents a length, m, and is nearest to that point of the surface of `tool`, in the
    /// reference configuration of that, such as the deepest one of a circle. The weight is zero where another
    /// face is as near: the point may be below the ridge between them.
    pub fn beside_ridge(nearest: &SurfacePoint, length: f64, tool: &RigidBody) -> Self {
        let SurfacePoint { point, normal, signed_distance } = *nearest;
        let depth = RAMP * length;
        let below = tool.surface.closest(point + (signed_distance - depth) * normal);
        let share = ((signed_distance - below.signed_distance) / depth).clamp(0.0, 1.0);
        let is_partial = share > 0.0 && share < 1.0;
        let gradient = if is_partial { (normal - below.normal) / depth } else { DVec3::ZERO };
        Self { share, gradient: tool.state.rotation * gradient, turning: DVec3::ZERO }
    }

    /// The same for a point of an edge along a unit vector in the reference configuration of `tool`. An edge
    /// that stands on the face is in contact at its ends and crossings.
    pub fn on_edge(edge: DVec3, nearest: &SurfacePoint, length: f64, tool: &RigidBody) -> Self {
        let normal = nearest.normal;
        let Self { share, gradient, .. } = Self::beside_ridge(nearest, length, tool);
        let rising = if normal.dot(edge) < 0.0 { -edge } else { edge };
        let (standing, turning) = share_of_slope(rising, normal);
        let lying = 1.0 - standing;
        let turning = tool.state.rotation * (-share * turning);
        Self { share: lying * share, gradient: lying * gradient, turning }
    }

    /// The share of a point where faces of these outward normals end, on a surface of that normal.
    pub fn beside_faces(self, ending: [DVec3; 4], normal: DVec3) -> Self {
        let flattest = ending.into_iter().map(|own| (-own.dot(normal), own));
        let (cosine, own) =
            flattest.fold((0.0, DVec3::ZERO), |best, next| if next.0 > best.0 { next } else { best });
        let (standing, turning) = growing((1.0 - cosine) / STANDING, own.cross(normal) / STANDING);
        let part = ON_FACE + (1.0 - ON_FACE) * standing;
        Self {
            share: part * self.share,
            gradient: part * self.gradient,
            turning: part * self.turning + self.share * (1.0 - ON_FACE) * turning,
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
