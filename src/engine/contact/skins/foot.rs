//! The point of a skin nearest to a position: its facet and the depth below the surface.

use glam::DVec3;

use super::facet_places::{FacetPlaces, point};
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

/// Facets of a patch among which a foot is looked for.
#[derive(Clone, Copy)]
pub(super) struct NearFacets<'a> {
    pub patch: &'a Patch,
    /// All facets of the patch.
    pub places: &'a FacetPlaces,
    pub facets: &'a [u32],
    /// Across periodic sides the image of a position that is nearest to a facet counts, if there are any.
    pub periodic: Option<Periodic>,
}

/// The nearest facet so far.
pub(super) struct NearestFacet<'a> {
    near: &'a NearFacets<'a>,
    x: DVec3,
    /// Distance below which a facet counts, m.
    pub reach: f64,
    /// The square of the distance, m2, and the facet, with the shares of its vertices at the foot.
    found: Option<(f64, u32, [f64; 3])>,
}

impl<'a> NearestFacet<'a> {
    /// None yet; those that are `farthest`, m, from `x` or farther do not count.
    #[inline(always)]
    pub fn new(near: &'a NearFacets<'a>, x: DVec3, farthest: f64) -> Self {
        Self { near, x, reach: farthest, found: None }
    }

    /// Looks at a facet. Of facets that are equally near it is the first one.
    #[inline(always)]
    pub fn look(&mut self, facet: u32) {
        let corners = &self.near.places.corners[facet as usize];
        let x = self.near.image_at(self.x, facet);
        let is_segment = self.near.patch.skin.facets.axes == 2;
        let shares = if is_segment { on_segment(x, corners) } else { on_triangle(x, corners) };
        let squared = point(corners, shares).distance_squared(x);
        let is_nearer = match self.found {
            None => squared < self.reach * self.reach,
            Some((least, first, _)) => squared < least || (squared == least && facet < first),
        };
        if is_nearer {
            (self.found, self.reach) = (Some((squared, facet, shares)), squared.sqrt());
        }
    }

    /// The facet.
    #[inline(always)]
    pub fn facet(&self) -> Option<u32> {
        self.found.map(|(_, facet, _)| facet)
    }

    /// The foot, if a facet was near.
    #[inline]
    pub fn foot(&self) -> Option<Foot> {
        let NearFacets { patch, places, .. } = *self.near;
        let axes = patch.skin.facets.axes;
        let (squared, facet, shares) = self.found?;
        let corners = &places.corners[facet as usize];
        let x = self.near.image_at(self.x, facet);
        let inner = shares[..axes].iter().filter(|share| **share > 0.0).count();
        if inner == axes {
            let normal = directed_area(axes, corners).normalize_or_zero();
            let distance = (x - corners[0]).dot(normal);
            return Some(Foot { x, facet, shares, normal, distance });
        }
        // Outside if in front of the mean of the facets that meet there.
        let arm = x - point(corners, shares);
        let sign = if arm.dot(mean_normal(patch, facet, shares)) < 0.0 { -1.0 } else { 1.0 };
        let distance = sign * squared.sqrt();
        Some(Foot { x, facet, shares, normal: arm.normalize_or_zero() * sign, distance })
    }
}

impl NearFacets<'_> {
    /// The image of a position that is nearest to the centre of a facet, m.
    #[inline(always)]
    pub fn image(&self, x: DVec3, center: DVec3) -> DVec3 {
        self.periodic.map_or(x, |periodic| center + periodic.minimal_image(x - center))
    }

    /// The same, for the facet of that number.
    #[inline(always)]
    fn image_at(&self, x: DVec3, facet: u32) -> DVec3 {
        self.periodic.map_or(x, |_| self.image(x, self.places.balls[facet as usize].xyz()))
    }

    /// The facet whose centre is nearest.
    fn with_nearest_center(&self, x: DVec3) -> Option<u32> {
        let (mut begin, mut least) = (*self.facets.first()?, f64::INFINITY);
        for &facet in self.facets {
            let center = self.places.balls[facet as usize].xyz();
            let squared = center.distance_squared(self.image(x, center));
            if squared < least {
                (begin, least) = (facet, squared);
            }
        }
        Some(begin)
    }
}

/// The foot of `x` on the nearest of some facets, if it is no farther than `farthest`, m. Facets whose balls
/// are farther than the nearest one so far are passed over.
pub(super) fn foot(near: &NearFacets<'_>, x: DVec3, farthest: f64) -> Option<Foot> {
    let mut nearest = NearestFacet::new(near, x, farthest);
    // Begun near by, so that most of the others are passed over.
    let begin = near.with_nearest_center(x)?;
    for &facet in std::iter::once(&begin).chain(near.facets) {
        let ball = near.places.balls[facet as usize];
        let (center, radius) = (ball.xyz(), ball.0[3]);
        if center.distance_squared(near.image(x, center)) <= (nearest.reach + radius).powi(2) {
            nearest.look(facet);
        }
    }
    nearest.foot()
}

/// The normals of the facets that meet at a vertex or an edge, weighted by the angles at which they do
/// (Baerentzen and Aanaes, IEEE Trans. Vis. Comput. Graph. 11, 2005).
fn mean_normal(patch: &Patch, facet: u32, shares: [f64; 3]) -> DVec3 {
    let skin = &patch.skin;
    let axes = skin.facets.axes;
    let own = skin.corners_of(facet);
    let mut ends = own.iter().zip(shares).filter(|(_, share)| *share > 0.0).map(|(&vertex, _)| vertex);
    let (Some(first), second) = (ends.next(), ends.next()) else { return DVec3::ZERO };
    let mut sum = DVec3::ZERO;
    for &other in skin.facets_at(first) {
        let vertices = skin.corners_of(other);
        // A foot far away may lie where the patch ends.
        let is_known = vertices.iter().all(|vertex| patch.has(*vertex));
        if !is_known || second.is_some_and(|second| !vertices.contains(&second)) {
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
#[inline(always)]
fn on_segment(x: DVec3, &[a, b, _]: &[DVec3; 3]) -> [f64; 3] {
    let along = b - a;
    let part = ((x - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    [1.0 - part, part, 0.0]
}

/// Shares of the corners of a triangle at the point nearest to `x` (Ericson, Real-Time Collision Detection
/// (2005), section 5.1.5).
fn on_triangle(x: DVec3, &[a, b, c]: &[DVec3; 3]) -> [f64; 3] {
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

/// The slope of a function that is linear on a facet, from its values at the vertices, and those of the
/// shares of the vertices, 1/m.
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
