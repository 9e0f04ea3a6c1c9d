//! The weight of a point of a face near the edge of the face that it touches.
//!
//! All points of a face are in contact. As a body slides over the points of another one, they enter below its
//! face at an edge, already at the depth of the overlap: a spring that began there would have spurious
//! energy, and a frictionless box that bounced on another one gained a quarter of its energy in two seconds.
//! So the energy of a point of a face is `w u(d)`, where w grows from zero at the edge of the other face to
//! one at a distance D from it,
//!
//! ```text
//! w = -s(p - D n) / D,      D = 0.4 of the length that the point stands for
//! ```
//!
//! with the nearest point p of the surface, its normal n, and the signed distance s. Along the face the force
//! is `-u grad w`, a share d/(2 D) of the normal force at most.

use glam::DVec3;

use crate::rigid::RigidBody;
use crate::shapes::SurfacePoint;

/// Distance from the edge of a face within which the weight of points decreases, over the length that a point
/// represents. Where faces and lattices are aligned the outermost points are half of that length inside: they
/// have full weight, and no force along the face.
const RAMP: f64 = 0.4;

/// The share w of a point, and its gradient, 1/m.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FaceShare {
    pub share: f64,
    pub gradient: DVec3,
}

impl FaceShare {
    /// For nodes that are no points of a face.
    pub const WHOLE: Self = Self { share: 1.0, gradient: DVec3::ZERO };

    /// For a point that represents a length, m, and is nearest to that point of the surface of `tool`, in the
    /// reference configuration.
    pub fn new(nearest: &SurfacePoint, length: f64, tool: &RigidBody) -> Self {
        let depth = RAMP * length;
        let below = tool.surface.closest(nearest.point - depth * nearest.normal);
        let share = (-below.signed_distance / depth).clamp(0.0, 1.0);
        let across = below.normal - nearest.normal * nearest.normal.dot(below.normal);
        let gradient = if share > 0.0 { tool.state.rotation * across / -depth } else { DVec3::ZERO };
        Self { share, gradient }
    }
}
