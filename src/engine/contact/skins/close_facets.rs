//! The facets of a skin that are close to a facet of another one.
//!
//! The feet of all points of a facet are on facets whose balls come within the depth of contact of its own
//! ball. They are selected once for its points, with their balls in rows, so that those which a point may
//! have its foot on are found several at once.

use glam::DVec3;

use super::foot::{Foot, NearFacets, NearestFacet, foot};
use crate::parallel::{FourLanes, HotLoop, Lanes4, Vector, run_hot};

/// Room for facets that are close to one: in three dimensions some twenty are on flat sides.
const ROOM: usize = 48;

/// The facets in which points of one facet may have their feet, kept from one of its points to the next.
pub(super) struct CloseFacets {
    /// The facet of the points.
    of: u32,
    /// Their number, and whether all have room.
    count: usize,
    has_room: bool,
    facets: [u32; ROOM],
    /// Their balls, at the images nearest to the facet of the points.
    centers: [[f64; ROOM]; 3],
    radii: [f64; ROOM],
    /// Squares of their distances from the point, m2.
    squared: [f64; ROOM],
    /// The facet with the foot of the last point.
    last: u32,
}

impl Default for CloseFacets {
    fn default() -> Self {
        Self {
            of: u32::MAX,
            count: 0,
            has_room: true,
            facets: [0; ROOM],
            centers: [[0.0; ROOM]; 3],
            radii: [0.0; ROOM],
            squared: [0.0; ROOM],
            last: u32::MAX,
        }
    }
}

impl CloseFacets {
    /// The foot of a point `x` of facet `of`, whose ball is `own`, if it is no farther than `farthest`, m.
    #[inline(always)]
    pub fn foot(
        &mut self,
        near: &NearFacets<'_>,
        (of, own): (u32, &Lanes4),
        x: DVec3,
        farthest: f64,
    ) -> Option<Foot> {
        if self.of != of {
            self.of = of;
            self.select(near, own, farthest);
        }
        if !self.has_room {
            return foot(near, x, farthest);
        }
        let nearest = self.nearest(near, x, farthest);
        self.last = nearest.facet().unwrap_or(self.last);
        nearest.foot()
    }

    /// Selects those no farther than `farthest`, m, from a facet with that ball.
    #[inline]
    fn select(&mut self, near: &NearFacets<'_>, own: &Lanes4, farthest: f64) {
        self.has_room = true;
        let (own, reach) = (own.xyz(), farthest + own.0[3]);
        run_hot(SelectClose { near, own, reach, close: self });
        if !self.has_room {
            return;
        }
        for k in 0..self.count {
            let ball = near.places.balls[self.facets[k] as usize];
            let center = near.image(ball.xyz(), own);
            [self.centers[0][k], self.centers[1][k], self.centers[2][k]] = center.to_array();
            self.radii[k] = ball.0[3];
        }
    }

    /// The nearest to `x`.
    #[inline(always)]
    fn nearest<'a>(&mut self, near: &'a NearFacets<'a>, x: DVec3, farthest: f64) -> NearestFacet<'a> {
        let Self { count, facets, centers: [xs, ys, zs], radii, squared, last, .. } = self;
        let count = *count;
        for k in 0..count {
            let (x, y, z) = (xs[k] - x.x, ys[k] - x.y, zs[k] - x.z);
            squared[k] = x * x + y * y + z * z;
        }
        let mut nearest = NearestFacet::new(near, x, farthest);
        if count == 0 {
            return nearest;
        }
        // Begun near by, so that most of the others are passed over.
        let begin = facets[..count].iter().position(|facet| facet == last).unwrap_or_else(|| {
            (1..count).fold(0, |least, k| if squared[k] < squared[least] { k } else { least })
        });
        nearest.look(facets[begin]);
        for k in 0..count {
            if squared[k] <= (nearest.reach + radii[k]).powi(2) && k != begin {
                nearest.look(facets[k]);
            }
        }
        nearest
    }
}

/// The search for close facets, four at once.
struct SelectClose<'a, 'c> {
    near: &'a NearFacets<'a>,
    /// Centre of the facet of the points, and how far from there balls of close ones are at most, m.
    own: DVec3,
    reach: f64,
    close: &'c mut CloseFacets,
}

impl SelectClose<'_, '_> {
    /// Looks at four facets; returns a bit for each that is close.
    #[inline(always)]
    fn look<A: FourLanes>(&self, a: A, four: &[u32; 4]) -> usize {
        let [j, k, l, m] = [four[0] as usize, four[1] as usize, four[2] as usize, four[3] as usize];
        let balls = &self.near.places.balls;
        let [x, y, z, radius] = a.transpose([balls[j], balls[k], balls[l], balls[m]]);
        let mut way = Vector::new(a, [x, y, z]) - Vector::splat(a, self.own);
        if let Some(periodic) = &self.near.periodic {
            way = periodic.minimal_images(way);
        }
        let limit = a.add(Lanes4::splat(self.reach), radius);
        a.below(way.length_squared().lanes(), a.mul(limit, limit))
    }

    /// Keeps those of four facets whose bit is set behind the first `count`; returns the number of all.
    #[inline(always)]
    fn keep(&mut self, four: &[u32; 4], is_close: usize, mut count: usize) -> usize {
        if count + 4 > ROOM {
            self.close.has_room = false;
            return 0;
        }
        // All are written, and some of them again: which are close cannot be predicted.
        for lane in 0..4 {
            self.close.facets[count] = four[lane];
            count += is_close >> lane & 1;
        }
        count
    }
}

impl HotLoop for SelectClose<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(mut self, a: A) {
        let (fours, rest) = self.near.facets.as_chunks::<4>();
        let mut count = 0;
        // By number: an iterator would be called.
        for n in 0..fours.len() {
            let is_close = self.look(a, &fours[n]);
            count = self.keep(&fours[n], is_close, count);
        }
        if !rest.is_empty() {
            let mut four = [rest[0]; 4];
            four[..rest.len()].copy_from_slice(rest);
            let is_close = self.look(a, &four) & ((1 << rest.len()) - 1);
            count = self.keep(&four, is_close, count);
        }
        self.close.count = count;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::facet_places::FacetPlaces;
    use super::*;
    use crate::neighbors::Periodic;
    use crate::skins::tests::{simulation, skin};
    use crate::skins::{Patch, SkinColumns, Wanted};
    use crate::world::BodyId;

    /// The distance of `x` from a triangle or segment: the least of those from its plane, if the projection
    /// is inside, and from its sides.
    fn distance(x: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
        let side = |p: DVec3, q: DVec3| {
            let part = (x - p).dot(q - p) / p.distance_squared(q).max(f64::MIN_POSITIVE);
            x.distance(p + part.clamp(0.0, 1.0) * (q - p))
        };
        let least = side(a, b).min(side(b, c)).min(side(c, a));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let is_inside = |p: DVec3, q: DVec3| normal.cross(q - p).dot(x - p) > 0.0;
        if is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
            least.min(normal.dot(x - a).abs())
        } else {
            least
        }
    }

    #[test]
    fn the_foot_is_on_the_nearest_of_all_facets() {
        // With the last reach more facets are close than there is room for.
        for (dimension, shape, farthest) in [
            ("Two", "Sphere(center: (0, 0), radius: 0.03)", 0.005),
            ("Three", "Sphere(center: (0, 0, 0), radius: 0.03)", 0.005),
            // Across a periodic side.
            ("Three", "Sphere(center: (0, 0, 0), radius: 0.03)", 0.01),
            ("Three", "Sphere(center: (0, 0, 0), radius: 0.03)", 0.02),
        ] {
            let sim = simulation(dimension, shape);
            let skin = Arc::new(skin(&sim, BodyId(0), dimension, shape));
            let columns = SkinColumns::new(&skin, sim.world()).unwrap();
            let mut patch = Patch::new(Arc::clone(&skin));
            let all: Vec<u32> = (0..skin.facets.corners.len() as u32).collect();
            patch.select(all.iter().copied());
            patch.update(&columns.view(), 0.0, Wanted::default());
            let mut places = FacetPlaces::with_capacity(all.len());
            places.locate(&patch, &all);
            let bounds = [DVec3::splat(-0.05), DVec3::splat(0.05)];
            let periodic = Periodic::new(bounds[0], bounds[1], [true, false, false]).unwrap();
            let periodic = (farthest == 0.01).then_some(periodic);
            let near = NearFacets { patch: &patch, places: &places, facets: &all, periodic };
            let mut close = CloseFacets::default();
            let (mut found, mut was_full) = (0, false);
            for &facet in &all {
                for k in 0..4 {
                    let number = f64::from(4 * facet + k);
                    let place = places.point(facet, [0.2, 0.3, 0.5]);
                    let x = place * (1.0 + 0.2 * (2.3 * number + 1.0).sin());
                    // Two points each of a facet elsewhere, whose ball contains them.
                    let period = if periodic.is_some() { 0.1 * DVec3::X } else { DVec3::ZERO };
                    let own = Lanes4::new(place - period, 0.2 * place.length());
                    let foot = close.foot(&near, (4 * facet + k / 2, &own), x - period, farthest);
                    was_full |= !close.has_room;
                    let least =
                        all.iter().map(|f| distance(x, places.corners[*f as usize])).fold(1.0, f64::min);
                    match foot {
                        Some(foot) => {
                            assert!((foot.distance.abs() - least).abs() < 1e-14, "{foot:?} {least}");
                            assert_eq!(foot.distance < 0.0, x.length() < place.length(), "{foot:?}");
                            found += 1;
                        }
                        None => assert!(least >= farthest * (1.0 - 1e-12), "{least}"),
                    }
                }
            }
            assert!(found > all.len() && (farthest < 0.02 || was_full), "{found} {was_full}");
        }
    }
}
