//! The point of a skin nearest to a position: its facet and the depth below the surface.

use glam::DVec3;

use crate::neighbors::Periodic;
use crate::shapes::directed_area;
use crate::skins::Patch;

/// The nearest point of a skin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Foot {
    /// The image of the position that is nearest to the facet, m.
    pub x: DVec3,
    /// Facet, and shares of its vertices at the foot.
    pub facet: u32,
    pub shares: [f64; 3],
    /// Outward unit vector: the normal inside of a facet, radial at edges and vertices.
    pub normal: DVec3,
    /// Distance from the surface, m; negative inside.
    pub distance: f64,
}

/// Centre of a facet, m, and how far it reaches from there, with something for round-off, m.
pub(super) type Ball = (DVec3, f64);

/// Computes the balls around the facets of a patch; `balls` has one for every facet of the skin.
pub(super) fn enclose(patch: &Patch, facets: &[u32], balls: &mut Vec<Ball>) {
    let axes = patch.skin.facets.axes;
    balls.resize(patch.skin.facets.corners.len(), (DVec3::ZERO, 0.0));
    for &facet in facets {
        let corners = patch.places(facet);
        let center = corners[..axes].iter().sum::<DVec3>() / axes as f64;
        let squared = corners.iter().map(|corner| corner.distance_squared(center)).fold(0.0, f64::max);
        let radius = squared.sqrt();
        balls[facet as usize] = (center, radius * (1.0 + 1e-9));
    }
}

/// Facets of a patch among which a foot is looked for.
#[derive(Clone, Copy)]
pub(in crate::contact) struct NearFacets<'a> {
    pub patch: &'a Patch,
    /// Around all facets of the patch.
    pub balls: &'a [Ball],
    pub facets: &'a [u32],
    /// Across periodic sides the image of a position that is nearest to a facet counts.
    pub periodic: Periodic,
}

/// The foot of `x` on the nearest of some facets, if it is no farther than `farthest`, m. Facets whose balls are farther than the nearest
/// one so far are passed over.
pub(in crate::contact) fn foot(near: &NearFacets<'_>, x: DVec3, farthest: f64) -> Option<Foot> {
    let NearFacets { patch, balls, facets, periodic } = *near;
    let is_periodic = periodic.any();
    let of_facet = |center: DVec3| if is_periodic { center + periodic.minimal_image(x - center) } else { x };
    let axes = patch.skin.facets.axes;
    let mut nearest: Option<(f64, u32, [f64; 3])> = None;
    let mut reach = farthest;
    for &facet in facets {
        let (center, radius) = balls[facet as usize];
        let x = of_facet(center);
        if center.distance_squared(x) > (reach + radius).powi(2) {
            continue;
        }
        let corners = patch.places(facet);
        let shares = if axes == 2 { on_segment(x, corners) } else { on_triangle(x, corners) };
        let squared = point(&corners, shares).distance_squared(x);
        if squared < nearest.map_or(farthest * farthest, |(squared, ..)| squared) {
            nearest = Some((squared, facet, shares));
            reach = squared.sqrt();
        }
    }
    let (squared, facet, shares) = nearest?;
    let x = of_facet(balls[facet as usize].0);
    let corners = patch.places(facet);
    let inner = shares[..axes].iter().filter(|share| **share > 0.0).count();
    if inner == axes {
        let normal = directed_area(axes, &corners).normalize_or_zero();
        let distance = (x - corners[0]).dot(normal);
        return Some(Foot { x, facet, shares, normal, distance });
    }
    // Outside if in front of the mean of the facets that meet there.
    let arm = x - point(&corners, shares);
    let sign = if arm.dot(mean_normal(patch, facet, shares)) < 0.0 { -1.0 } else { 1.0 };
    let distance = sign * squared.sqrt();
    Some(Foot { x, facet, shares, normal: arm.normalize_or_zero() * sign, distance })
}

fn point(corners: &[DVec3; 3], shares: [f64; 3]) -> DVec3 {
    shares[0] * corners[0] + shares[1] * corners[1] + shares[2] * corners[2]
}

/// The normals of the facets that meet at a vertex or an edge, weighted by the angles at which they do (Baerentzen and Aanaes, IEEE Trans. Vis. Comput.
/// Graph. 11, 2005).
fn mean_normal(patch: &Patch, facet: u32, shares: [f64; 3]) -> DVec3 {
    let skin = &patch.skin;
    let axes = skin.facets.axes;
    let own = skin.corners_of(facet);
    let on: [Option<u32>; 3] =
        [0, 1, 2].map(|k| if k < axes && shares[k] > 0.0 { Some(own[k]) } else { None });
    let mut ends = on.into_iter().flatten();
    let (Some(first), second) = (ends.next(), ends.next()) else { return DVec3::ZERO };
    let mut sum = DVec3::ZERO;
    for &other in skin.facets_at(first) {
        let vertices = skin.corners_of(other);
        if second.is_some_and(|second| !vertices.contains(&second)) {
            continue;
        }
        let corners = patch.places(other);
        let normal = directed_area(axes, &corners).normalize_or_zero();
        let angle = match (axes, second) {
            (3, None) => angle_at(&corners, vertices.iter().position(|&vertex| vertex == first).unwrap_or(0)),
            _ => 1.0,
        };
        sum += angle * normal;
    }
    sum
}

fn angle_at(corners: &[DVec3; 3], k: usize) -> f64 {
    let [a, b, c] = [k, k + 1, k + 2].map(|k| corners[k % 3]);
    (b - a).angle_between(c - a)
}

/// Shares of the ends of a segment at the point nearest to `x`.
fn on_segment(x: DVec3, [a, b, _]: [DVec3; 3]) -> [f64; 3] {
    let along = b - a;
    let part = ((x - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    [1.0 - part, part, 0.0]
}

/// Shares of the corners of a triangle at the point nearest to `x` (Ericson, Real-Time Collision Detection (2005), section 5.1.5).
fn on_triangle(x: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac, ap, bp, cp) = (b - a, c - a, x - a, x - b, x - c);
    let (d1, d2, d3, d4, d5, d6) = (ab.dot(ap), ac.dot(ap), ab.dot(bp), ac.dot(bp), ab.dot(cp), ac.dot(cp));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let part = d1 / (d1 - d3);
        return [1.0 - part, part, 0.0];
    }
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let part = d2 / (d2 - d6);
        return [1.0 - part, 0.0, part];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - part, part];
    }
    let sum = va + vb + vc;
    [va / sum, vb / sum, vc / sum]
}

/// The slope of a function that is linear on a facet, from its values at the vertices, and those of the shares of the vertices, 1/m.
pub(super) fn slopes(axes: usize, corners: &[DVec3; 3], values: [f64; 3]) -> (DVec3, [DVec3; 3]) {
    let [a, b, c] = *corners;
    let of_shares = if axes == 2 {
        let along = (b - a) / (b - a).length_squared();
        [-along, along, DVec3::ZERO]
    } else {
        let area = (b - a).cross(c - a);
        let over = area / area.length_squared();
        [over.cross(c - b), over.cross(a - c), over.cross(b - a)]
    };
    ((0..3).map(|k| values[k] * of_shares[k]).sum(), of_shares)
}
