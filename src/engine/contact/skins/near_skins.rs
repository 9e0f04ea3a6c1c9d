//! Facets of two skins that may touch each other, searched again when the skins have moved by the margin of
//! the search.
//!
//! Bounds of the speeds of the bodies say when the skins may have moved so far. Then the displacements of
//! their vertices are evaluated, and where they are smaller, the facets are kept. The search covers regions
//! of the skins, which are searched again when the bodies may have moved a few spacings.
//!
//! Of one skin that may touch itself, facets that are near each other in the reference configuration are left
//! out: those that bonds hold apart, and those with no gap between them, such as both sides of a thin part,
//! or one side that is compressed.

use glam::DVec3;

use super::displaced::{Displaced, approach};
use super::near_tool::{FASTER, MARGIN};
use super::region::SkinRegion;
use crate::contact::bodies::{APART, MotionBounds};
use crate::contact::response::PairKey;
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::parallel::{Picked, for_each_block};
use crate::shapes::Aabb;
use crate::skins::{Skin, SkinView};

/// Gap over the spacing up to which facets are candidates.
const NEAR: f64 = 1.5;
/// How far the corners of a facet are from its centre at most, over the spacing, in two and three dimensions,
/// and by how much it may be stretched before a period is too short.
const LONGEST: [f64; 2] = [0.25, 0.75];
/// Distance in the reference configuration up to which one of two facets of a skin has to face the other,
/// over the spacing: others come within half a spacing only as the body is deformed to an eighth.
const ONE_PART: f64 = 4.0;
/// Sine of the angle between a facet and the way to another one, above which it faces that.
const FACING: f64 = 1e-3;
/// Share of the margin that must be left for the facets to be kept.
const KEPT: f64 = 0.3;
const STRETCHED: f64 = 2.0;

/// The facets of two skins that are near each other.
pub(super) struct NearSkins {
    /// How far the bodies may still move until there are others, m.
    left: f64,
    /// Whether there is memory for all that facets near each other need.
    has_capacity: bool,
    periodic: Periodic,
    /// Facets of the reference configuration, if both skins are one.
    of_itself: Option<ReferenceFacets>,
    regions: [SkinRegion; 2],
    /// Where the vertices are, m, and where they were when the facets were found.
    places: [Vec<DVec3>; 2],
    found_at: [Vec<DVec3>; 2],
    /// Whether any facets were near each other then.
    is_near: bool,
    /// Centres of the facets of the regions, m.
    centers: [Vec<DVec3>; 2],
    /// Facets that have others near them.
    near: Vec<u32>,
    search: NeighborSearch,
    lists: [NeighborList; 2],
    /// The facets of the other side near every facet, and where those of each begin.
    starts: [Vec<u32>; 2],
    others: [Vec<u32>; 2],
    /// Facets of each side that may touch, and those around them, ascending.
    pub facets: [Vec<u32>; 2],
    /// Points of the facets of each side that may touch.
    pub candidates: [Vec<PairKey>; 2],
}

impl NearSkins {
    /// None yet.
    pub fn new(skins: [&Skin; 2], periodic: Periodic) -> Self {
        let vertices = skins.map(|skin| vec![DVec3::ZERO; skin.vertices()]);
        let of_facets = |more: usize| skins.map(|skin| Vec::with_capacity(skin.facets.corners.len() + more));
        Self {
            left: 0.0,
            has_capacity: false,
            periodic,
            of_itself: (skins[0].body == skins[1].body).then(|| ReferenceFacets::of(skins[0])),
            regions: skins.map(SkinRegion::new),
            found_at: vertices.clone(),
            is_near: false,
            places: vertices,
            centers: skins.map(|skin| Vec::with_capacity(skin.facets.corners.len())),
            near: Vec::new(),
            search: NeighborSearch::default(),
            lists: Default::default(),
            starts: of_facets(1),
            others: Default::default(),
            facets: Default::default(),
            candidates: Default::default(),
        }
    }

    /// Minimum period of a domain in which no facet has two images near another one, m.
    pub fn min_period(skins: [&Skin; 2]) -> f64 {
        let spacing = 0.5 * (skins[0].spacing + skins[1].spacing);
        2.0 * (NEAR + 2.0 * STRETCHED * LONGEST[skins[0].facets.axes - 2]) * spacing
    }

    /// Takes in a step in which points of both skins come closer by `way`, m, at most. Says whether the
    /// facets have to be found again.
    pub fn is_old(&mut self, way: f64) -> bool {
        self.left -= way;
        self.regions.iter_mut().for_each(|region| region.left -= way);
        // What is not a number must not keep old candidates.
        self.left.is_nan() || self.left <= 0.0
    }

    /// Has all facets searched again.
    pub fn forget(&mut self) {
        self.left = 0.0;
        self.regions.iter_mut().for_each(|region| region.left = 0.0);
    }

    /// Whether no facets are near each other.
    pub fn is_empty(&self) -> bool {
        self.candidates.iter().all(Vec::is_empty)
    }

    /// The facets of the other side near a facet of this one.
    pub fn facets_near(&self, side: usize, facet: u32) -> &[u32] {
        match self.starts[side].get(facet as usize..facet as usize + 2) {
            Some(&[start, end]) => &self.others[side][start as usize..end as usize],
            _ => &[],
        }
    }

    /// Finds the facets near each other, and the points on them. Says whether there may be others than
    /// before.
    pub fn find(
        &mut self,
        skins: [&Skin; 2],
        views: &[SkinView<'_>; 2],
        points: usize,
    ) -> Result<bool, NeighborError> {
        let spacing = 0.5 * (skins[0].spacing + skins[1].spacing);
        let near = NEAR * spacing;
        let is_old = self.regions.iter().any(SkinRegion::is_old);
        if is_old {
            (0..2).for_each(|side| self.regions[side].take_all(skins[side]));
        }
        (0..2).for_each(|side| self.look(side, &views[side]));
        if !is_old && self.is_near && self.keeps(near, MARGIN * spacing) {
            return Ok(false);
        }
        let mut largest = [0, 1].map(|side| self.find_centers(side, skins[side]));
        if !std::mem::replace(&mut self.has_capacity, true) {
            self.reserve(skins, points, largest[0] + largest[1] + near)?;
        }
        if is_old {
            let boxes = [0, 1].map(|side| self.around(side));
            for side in 0..2 {
                let Self { regions, centers, .. } = self;
                let (other, centers, periodic) = (&boxes[1 - side], &centers[side], &self.periodic);
                let gap = |facet: u32| distance(other, centers[facet as usize], periodic) - largest[side];
                regions[side].choose(skins[side], near, gap);
            }
            largest = [0, 1].map(|side| self.find_centers(side, skins[side]));
        }
        let [first, second] = [0, 1].map(|side| self.around(side));
        let gap = if self.regions.iter().any(|region| region.facets.is_empty()) {
            f64::INFINITY
        } else {
            gap_of(&first, &second, &self.periodic)
        };
        let beyond = near + self.regions[0].left.min(self.regions[1].left);
        self.left = gap.max(near).min(beyond) - MARGIN * spacing;
        for side in 0..2 {
            self.candidates[side].clear();
            self.facets[side].clear();
        }
        if gap <= near {
            self.pair(skins, largest[0] + largest[1] + near, points)?;
        }
        self.is_near = gap <= near;
        for side in 0..2 {
            let (places, found_at) = (&self.places[side], &mut self.found_at[side]);
            let vertices = self.regions[side].vertices.iter().map(|&vertex| vertex as usize);
            vertices.for_each(|vertex| found_at[vertex] = places[vertex]);
        }
        Ok(true)
    }

    /// Keeps the facets within `near`, m, if the vertices of the regions have moved so little that no others
    /// come closer than `margin`, m, soon.
    fn keeps(&mut self, near: f64, margin: f64) -> bool {
        let Self { regions, found_at, places, .. } = self;
        let of_side = |side: usize| Displaced {
            vertices: &regions[side].vertices,
            before: &found_at[side],
            now: &places[side],
        };
        let beyond = near + regions[0].left.min(regions[1].left);
        let left = (near - approach([of_side(0), of_side(1)])).min(beyond) - margin;
        let keeps = left > KEPT * (near - margin);
        if keeps {
            self.left = left;
        }
        keeps
    }

    /// Pairs the facets of the regions whose centres are no farther apart than `reach`, m.
    fn pair(&mut self, skins: [&Skin; 2], reach: f64, points: usize) -> Result<(), NeighborError> {
        // What touches itself has all in the first side.
        let sides = if self.of_itself.is_some() { 1 } else { 2 };
        let clouds = [0, 1].map(|side| Cloud::uniform(&self.centers[side], reach));
        for side in 0..sides {
            self.search.between(
                clouds[side],
                clouds[1 - side],
                0.0,
                &self.periodic,
                &mut self.lists[side],
            )?;
        }
        for side in 0..sides {
            let (skin, list) = (skins[side], &self.lists[side]);
            let (own, other) = (&self.regions[side].facets, &self.regions[1 - side].facets);
            let (starts, others) = (&mut self.starts[side], &mut self.others[side]);
            let (of_itself, periodic) = (self.of_itself.as_ref(), &self.periodic);
            let may_touch = |facet: u32, other: u32| {
                of_itself.is_none_or(|facets| facets.may_touch(facet, other, skin.spacing, periodic))
            };
            starts.clear();
            others.clear();
            self.near.clear();
            for (row, &facet) in own.iter().enumerate() {
                starts.resize(facet as usize + 1, others.len() as u32);
                let before = others.len();
                let near = list.row(row).iter().map(|&k| other[k as usize]);
                others.extend(near.filter(|&other| may_touch(facet, other)));
                if others.len() > before {
                    self.near.push(facet);
                }
            }
            starts.resize(skin.facets.corners.len() + 1, others.len() as u32);
            let count = points as u32;
            let points = self.near.iter().flat_map(|facet| (0..count).map(move |k| (facet * count + k, 0)));
            self.candidates[side].extend(points);
            let vertices = self.near.iter().flat_map(|&facet| skin.corners_of(facet));
            self.facets[side].extend(vertices.flat_map(|&vertex| skin.facets_at(vertex)));
            self.facets[side].sort_unstable();
            self.facets[side].dedup();
        }
        if sides == 1 {
            let [first, second] = &mut self.facets;
            second.clone_from(first);
        }
        Ok(())
    }

    /// Reserves memory before contact: each facet may have as many of the other skin near it as it has of its
    /// own.
    fn reserve(&mut self, skins: [&Skin; 2], points: usize, reach: f64) -> Result<(), NeighborError> {
        for side in 0..2 {
            let facets = skins[side].facets.corners.len();
            let vertices = 0..skins[side].vertices() as u32;
            let around: usize = vertices.map(|vertex| skins[side].facets_at(vertex).len().pow(2)).sum();
            self.near.reserve(facets);
            self.candidates[side].reserve(facets * points);
            self.facets[side].reserve(around);
            let own = Cloud::uniform(&self.centers[side], reach);
            self.search.between(own, own, 0.0, &Periodic::NONE, &mut self.lists[side])?;
            self.others[side].reserve((0..facets).map(|row| self.lists[side].row(row).len()).sum());
        }
        Ok(())
    }

    /// Computes the positions of the vertices of the region of a side.
    fn look(&mut self, side: usize, view: &SkinView<'_>) {
        let rows = Picked::new(&self.regions[side].vertices, &mut self.places[side]);
        for_each_block(rows, &mut Vec::new(), &|_, mut rows: Picked<'_, DVec3>| {
            view.places(rows.numbers(), &mut |k, place, _| *rows.row(k) = place);
        });
    }

    /// Finds the centres of the facets of the region of a side; returns how far the vertices of one are from
    /// its centre at most, m.
    fn find_centers(&mut self, side: usize, skin: &Skin) -> f64 {
        let (centers, places) = (&mut self.centers[side], &self.places[side]);
        centers.clear();
        let mut largest = 0.0_f64;
        for &facet in &self.regions[side].facets {
            let ends = || skin.corners_of(facet).iter().map(|&vertex| places[vertex as usize]);
            let center = ends().sum::<DVec3>() / skin.facets.axes as f64;
            largest = ends().map(|end| end.distance(center)).fold(largest, f64::max);
            centers.push(center);
        }
        largest
    }

    /// The box around the region of a side.
    fn around(&self, side: usize) -> Aabb {
        Aabb::around(self.regions[side].vertices.iter().map(|&vertex| self.places[side][vertex as usize]))
    }
}

/// The facets of a skin that may touch itself.
struct ReferenceFacets {
    /// Centres, m, and outward normals.
    facets: Vec<(DVec3, DVec3)>,
}

impl ReferenceFacets {
    fn of(skin: &Skin) -> Self {
        let facet = |k: usize| (skin.facets.center(k), skin.facets.normal_and_measure(k).0);
        Self { facets: (0..skin.facets.corners.len()).map(facet).collect() }
    }

    /// Whether two of them may touch each other.
    fn may_touch(&self, facet: u32, other: u32, spacing: f64, periodic: &Periodic) -> bool {
        let ((own, normal), (there, across)) = (self.facets[facet as usize], self.facets[other as usize]);
        let way = periodic.minimal_image(there - own);
        let least = FACING * way.length();
        let has_gap = way.dot(normal) > least || way.dot(across) < -least;
        // Particles beside two facets are a spacing farther apart than these.
        way.length() > if has_gap { APART - 1.0 } else { ONE_PART } * spacing
    }
}

/// A bound of how fast points of the skins of two bodies approach each other, m/s.
#[inline]
pub(in crate::contact) fn speed_of_points([first, second]: [MotionBounds; 2]) -> f64 {
    first.velocity.distance(second.velocity) + FASTER * (first.spread + second.spread)
}

/// How far a place, or an image of it, is from a box at least, m.
fn distance(around: &Aabb, x: DVec3, periodic: &Periodic) -> f64 {
    gap_of(around, &Aabb { min: x, max: x }, periodic)
}

/// How far two boxes, or images of them, are apart at least, m.
pub(in crate::contact) fn gap_of(first: &Aabb, second: &Aabb, periodic: &Periodic) -> f64 {
    if !periodic.any() {
        return (first.min - second.max).max(second.min - first.max).max(DVec3::ZERO).length();
    }
    let middle = |around: &Aabb| 0.5 * (around.min + around.max);
    let half = 0.5 * (first.max - first.min + second.max - second.min);
    let way = periodic.minimal_image(middle(second) - middle(first));
    (way.abs() - half).max(DVec3::ZERO).length()
}
