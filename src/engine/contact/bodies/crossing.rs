//! Where a straight edge of a rigid body crosses a sharp edge of a surface.
//!
//! Points on both edges, however dense, pass each other by. What two edges have in common is the deepest
//! point of one inside of the other body: along the edge `x(s) = a + s e` the signed distance of a convex
//! body has one minimum, where the slope n . e changes its sign. There the edge passes below a ridge, from
//! the face of normal n_1 to that of n_2, and the overlap is the depth d of that point. Because it is a
//! minimum over s, its derivative with a motion of the bodies is that at a fixed s,
//!
//! ```text
//! grad d = -g,     g = l_1 n_1 + l_2 n_2,     g . e = 0,     l_1 + l_2 = 1
//! ```
//!
//! which is across both edges. So the force is the derivative of an energy, and does not jump where the edge
//! slides along the ridge. A spring must not begin at a finite depth: the energy has a weight w, the product
//! of three. Each grows from zero to one: with the smaller slope, because an edge that lies along a face
//! crosses the end of that face without a force; with the distance from the ends of the edge, where the
//! deepest point is a corner; and with the distance of a third face, where the ridge ends.

use glam::DVec3;

use crate::shapes::{Surface, SurfacePoint};

/// Slopes over the faces on both sides of a ridge below which it counts as flat, and from which on it counts
/// whole: sines of 6 and 24 degrees.
const SLOPES: [f64; 2] = [0.1, 0.4];
/// Distance within which weights grow, over the length that a node represents. Where faces and lattices are
/// aligned the outermost points of a face are half of that length inside: they have full weight.
pub(in crate::contact) const RAMP: f64 = 0.4;
/// Bisections: they reduce the length of an edge to round-off.
const BISECTIONS: usize = 48;

/// The crossing of an edge and a ridge, in the reference configuration of the surface.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Crossing {
    /// The deepest point of the edge, m, its signed distance, m, and the unit vector across both edges,
    /// outward.
    pub at: SurfacePoint,
    /// d(overlap)/d(approach along the normal): |g|.
    pub scale: f64,
    /// w.
    pub share: f64,
}

/// A point of the edge, and the surface beside it.
struct EdgePoint {
    x: DVec3,
    normal: DVec3,
    distance: f64,
}

impl EdgePoint {
    fn new(surface: &dyn Surface, x: DVec3) -> Self {
        let SurfacePoint { normal, signed_distance, .. } = surface.closest(x);
        Self { x, normal, distance: signed_distance }
    }
}

impl Crossing {
    /// Of the edge between two ends that represents a length, m, if it comes so near to the surface.
    pub fn of(surface: &dyn Surface, ends: [DVec3; 2], size: f64) -> Option<Self> {
        let length = ends[0].distance(ends[1]);
        let e = (ends[1] - ends[0]) / length;
        let [mut before, mut after] = ends.map(|end| EdgePoint::new(surface, end));
        if before.normal.dot(e) >= 0.0 || after.normal.dot(e) <= 0.0 {
            return None;
        }
        let mut half = 0.5 * length;
        for _ in 0..BISECTIONS {
            let middle = EdgePoint::new(surface, 0.5 * (before.x + after.x));
            // A distance changes by as much as the way at most.
            if middle.distance - half > size {
                return None;
            }
            half *= 0.5;
            if middle.normal.dot(e) < 0.0 { before = middle } else { after = middle }
        }
        let (point, normals) = (0.5 * (before.x + after.x), [before.normal, after.normal]);
        let slopes = [-normals[0].dot(e), normals[1].dot(e)];
        let g = (slopes[1] * normals[0] + slopes[0] * normals[1]) / (slopes[0] + slopes[1]);
        let (scale, signed_distance) = (g.length(), before.distance.max(after.distance));
        let at = SurfacePoint { point, normal: g / scale, signed_distance };
        let mut crossing = Self { at, scale, share: 0.0 };
        if signed_distance < 0.0 {
            let from_end = point.distance(ends[0]).min(point.distance(ends[1]));
            crossing.share = crossing.weight(surface, e, from_end, normals, RAMP * size);
        }
        Some(crossing)
    }

    /// Weight of a crossing of faces of these normals that is `from_end`, m, away from an end of the edge
    /// along the unit vector e; it grows within `ramp`, m.
    fn weight(&self, surface: &dyn Surface, e: DVec3, from_end: f64, normals: [DVec3; 2], ramp: f64) -> f64 {
        let SurfacePoint { point, signed_distance, .. } = self.at;
        // Deeper by `ramp` below both faces.
        let below =
            surface.closest(point - (normals[0] + normals[1]) * (ramp / (1.0 + normals[0].dot(normals[1]))));
        let free = (signed_distance - below.signed_distance) / ramp;
        let flatter = normals[0].dot(e).abs().min(normals[1].dot(e).abs());
        share_of_slope(flatter) * (from_end / ramp).clamp(0.0, 1.0) * free.clamp(0.0, 1.0)
    }
}

/// The share of an edge that rises over a face, or of a face that is inclined to another one, by an angle of
/// that sine.
pub(in crate::contact) fn share_of_slope(sine: f64) -> f64 {
    ((sine - SLOPES[0]) / (SLOPES[1] - SLOPES[0])).clamp(0.0, 1.0)
}
