//! One triangle: nearest point, intersection with a segment.

use glam::DVec3;

/// The feature of a triangle on which a nearest point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TrianglePart {
    Face,
    /// The edge from corner k to the next.
    Edge(usize),
    Corner(usize),
}

/// The point of triangle `t` that is nearest to `p`, and its feature.
///
/// Ericson, Real-Time Collision Detection (2005), section 5.1.5; triangles of zero area are treated as their
/// edges.
pub(super) fn closest(p: DVec3, [a, b, c]: [DVec3; 3]) -> (DVec3, TrianglePart) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, TrianglePart::Corner(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, TrianglePart::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
        return (a + d1 / (d1 - d3) * ab, TrianglePart::Edge(0));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, TrianglePart::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6 {
        return (a + d2 / (d2 - d6) * ac, TrianglePart::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    let (to_c, to_b) = (d4 - d3, d5 - d6);
    if va <= 0.0 && to_c >= 0.0 && to_b >= 0.0 && to_c + to_b > 0.0 {
        return (b + to_c / (to_c + to_b) * (c - b), TrianglePart::Edge(1));
    }
    let sum = va + vb + vc;
    if sum <= 0.0 {
        return (a, TrianglePart::Corner(0));
    }
    (a + vb / sum * ab + vc / sum * ac, TrianglePart::Face)
}

/// Whether the segment from `p` to `q` crosses triangle `t`. An end point on the triangle does not count.
pub(super) fn is_pierced([a, b, c]: [DVec3; 3], p: DVec3, q: DVec3) -> bool {
    // Six times the volume of a tetrahedron, and its bound of round-off.
    let size = [b - a, c - a, p - a, q - a].iter().fold(0.0, |size: f64, edge| size.max(edge.length()));
    let nothing = 1e-12 * size.powi(3);
    let volume = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| (b - a).cross(c - a).dot(d - a);
    let (start, end) = (volume(a, b, c, p), volume(a, b, c, q));
    if start.abs() <= nothing || end.abs() <= nothing || (start > 0.0) == (end > 0.0) {
        return false;
    }
    let sides = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    sides.iter().all(|&side| side >= -nothing) || sides.iter().all(|&side| side <= nothing)
}
