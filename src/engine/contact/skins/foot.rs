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

/// A facet in this step, with a ball around it.
#[derive(Clone, Copy, Default)]
pub(super) struct FacetPlace {
    center: DVec3,
    /// How far it reaches from there, with something for round-off, m.
    radius: f64,
    /// Where its vertices are, m; segments have two, and the last one twice.
    corners: [DVec3; 3],
}

impl FacetPlace {
    /// Where the point with these shares of its vertices is, m.
    #[inline(always)]
    pub fn point(&self, shares: [f64; 3]) -> DVec3 {
        point(&self.corners, shares)
    }
}

/// Computes where the facets of a patch are; `places` has one for every facet of the skin.
pub(super) fn locate(patch: &Patch, facets: &[u32], places: &mut Vec<FacetPlace>) {
    let axes = patch.skin.facets.axes;
    places.resize(patch.skin.facets.corners.len(), FacetPlace::default());
    for &facet in facets {
        let [a, b, c] = patch.places(facet);
        let center = if axes == 2 { 0.5 * (a + b) } else { (a + b + c) / 3.0 };
        let far = a.distance_squared(center).max(b.distance_squared(center)).max(c.distance_squared(center));
        places[facet as usize] = FacetPlace { center, radius: far.sqrt() * (1.0 + 1e-9), corners: [a, b, c] };
    }
}

/// Facets of a patch among which a foot is looked for.
#[derive(Clone, Copy)]
pub(super) struct NearFacets<'a> {
    pub patch: &'a Patch,
    /// All facets of the patch.
    pub places: &'a [FacetPlace],
    pub facets: &'a [u32],
    /// Across periodic sides the image of a position that is nearest to a facet counts, if there are any.
    pub periodic: Option<Periodic>,
}

/// The facets in which points of one facet may have their feet, kept from one of its points to the next.
pub(super) struct CloseFacets {
    /// The facet of the points.
    of: u32,
    facets: [u32; ROOM],
    /// Their number; none if they do not fit.
    count: Option<usize>,
    /// The one with the foot of the last point.
    pub last: Option<u32>,
}

/// Room for facets that are close to one: in three dimensions some twenty are on flat sides.
const ROOM: usize = 40;

impl Default for CloseFacets {
    fn default() -> Self {
        Self { of: u32::MAX, facets: [0; ROOM], count: None, last: None }
    }
}

impl CloseFacets {
    /// Looks for those of `near` no farther than `farthest`, m, from that facet.
    #[inline(always)]
    pub fn find(&mut self, number: u32, own: &FacetPlace, near: &NearFacets<'_>, farthest: f64) {
        if self.of == number {
            return;
        }
        (self.of, self.last) = (number, None);
        let mut count = 0;
        for &facet in near.facets {
            let FacetPlace { center, radius, .. } = &near.places[facet as usize];
            let apart = center.distance_squared(near.image(own.center, *center));
            if apart <= (farthest + radius + own.radius).powi(2) {
                self.facets[count % ROOM] = facet;
                count += 1;
            }
        }
        self.count = (count <= ROOM).then_some(count);
    }

    /// What has been found; all of `near` if there was no space.
    #[inline(always)]
    pub fn facets<'a>(&'a self, near: &NearFacets<'a>) -> &'a [u32] {
        self.count.map_or(near.facets, |count| &self.facets[..count])
    }
}

impl NearFacets<'_> {
    /// The image of a position that is nearest to the centre of a facet, m.
    #[inline(always)]
    fn image(&self, x: DVec3, center: DVec3) -> DVec3 {
        self.periodic.map_or(x, |periodic| center + periodic.minimal_image(x - center))
    }

    /// The facet with the point nearest to `x`, with the square of its distance, m2, and the shares of the
    /// vertices there, if that is less than `farthest`, m. Of facets that are equally near it is the first
    /// one. It is looked for from `begin` on, which need not be near; without one, from where the centre is
    /// nearest.
    #[inline(always)]
    fn nearest(&self, x: DVec3, farthest: f64, begin: Option<u32>) -> Option<(f64, u32, [f64; 3])> {
        let Self { patch, places, facets, .. } = *self;
        let axes = patch.skin.facets.axes;
        let begin = match begin {
            Some(facet) => facet,
            None => self.with_nearest_center(x)?,
        };
        let mut nearest = (farthest * farthest, 0, [0.0; 3]);
        let (mut reach, mut is_found) = (farthest, false);
        // Begun near by, so that most of the others are passed over.
        let mut look = |facet: u32| {
            let FacetPlace { center, radius, corners } = &places[facet as usize];
            let x = self.image(x, *center);
            if center.distance_squared(x) > (reach + radius).powi(2) {
                return;
            }
            let shares = if axes == 2 { on_segment(x, corners) } else { on_triangle(x, corners) };
            let squared = point(corners, shares).distance_squared(x);
            if squared < nearest.0 || (squared == nearest.0 && facet < nearest.1) {
                (nearest, reach, is_found) = ((squared, facet, shares), squared.sqrt(), true);
            }
        };
        look(begin);
        facets.iter().filter(|facet| **facet != begin).for_each(|facet| look(*facet));
        is_found.then_some(nearest)
    }

    /// The facet whose centre is nearest.
    #[inline(always)]
    fn with_nearest_center(&self, x: DVec3) -> Option<u32> {
        let (mut begin, mut least) = (*self.facets.first()?, f64::INFINITY);
        for &facet in self.facets {
            let center = self.places[facet as usize].center;
            let squared = center.distance_squared(self.image(x, center));
            if squared < least {
                (begin, least) = (facet, squared);
            }
        }
        Some(begin)
    }
}

/// The foot of `x` on the nearest of some facets, looked for from `begin` on, if it is no farther than
/// `farthest`, m. Facets whose balls are farther than the nearest one so far are passed over.
#[inline]
pub(super) fn foot(near: &NearFacets<'_>, x: DVec3, farthest: f64, begin: Option<u32>) -> Option<Foot> {
    let NearFacets { patch, places, .. } = *near;
    let axes = patch.skin.facets.axes;
    let (squared, facet, shares) = near.nearest(x, farthest, begin)?;
    let FacetPlace { center, corners, .. } = &places[facet as usize];
    let x = near.image(x, *center);
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

#[inline(always)]
fn point(corners: &[DVec3; 3], shares: [f64; 3]) -> DVec3 {
    shares[0] * corners[0] + shares[1] * corners[1] + shares[2] * corners[2]
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
