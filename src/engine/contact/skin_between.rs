//! Which facets of two skins may touch each other, found again when the bodies may have moved by the skin of the search.

use glam::DVec3;

use super::memory::PairKey;
use super::skin_near::{FASTER, MARGIN};
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::parallel::for_each_block;
use crate::shapes::Aabb;
use crate::skins::{Skin, SkinView};

/// Gap over the spacing up to which facets are candidates.
const NEAR: f64 = 1.5;

/// The facets of two skins that are near each other.
#[derive(Default)]
pub(super) struct NearSkins {
    /// How far the bodies may still move until there are others, m.
    left: f64,
    /// Whether there is room for all that facets near each other need.
    has_room: bool,
    places: Vec<(u32, DVec3)>,
    centers: [Vec<DVec3>; 2],
    /// Facets that have others near them.
    near: Vec<u32>,
    search: NeighborSearch,
    lists: [NeighborList; 2],
    /// Facets of each side that may touch, and those around them, ascending.
    pub facets: [Vec<u32>; 2],
    /// Points of the facets of each side that may touch.
    pub candidates: [Vec<PairKey>; 2],
}

impl NearSkins {
    /// Takes in a step of that length, s, with a largest speed of both bodies together, m/s. Says whether the facets have to be found again.
    pub fn is_old(&mut self, speed: f64, dt: f64) -> bool {
        self.left -= FASTER * speed * dt;
        // What is not a number must not keep old candidates.
        self.left.is_nan() || self.left <= 0.0
    }

    /// The facets of the other side near a facet of this one.
    pub fn facets_near(&self, side: usize, facet: u32) -> &[u32] {
        self.lists[side].row(facet as usize)
    }

    /// Finds the facets near each other, and the points on them.
    pub fn find(
        &mut self,
        skins: [&Skin; 2],
        views: &[SkinView<'_>; 2],
        points: usize,
    ) -> Result<(), NeighborError> {
        let spacing = 0.5 * (skins[0].spacing + skins[1].spacing);
        let mut largest = [0.0_f64; 2];
        let mut boxes = [Aabb { min: DVec3::ZERO, max: DVec3::ZERO }; 2];
        for side in 0..2 {
            (largest[side], boxes[side]) = self.look(side, skins[side], &views[side]);
        }
        let reach = largest[0] + largest[1] + NEAR * spacing;
        let gap = (boxes[0].min - boxes[1].max).max(boxes[1].min - boxes[0].max).max(DVec3::ZERO).length();
        self.left = gap.max(NEAR * spacing) - MARGIN * spacing;
        let is_far = gap > NEAR * spacing;
        for side in 0..2 {
            self.candidates[side].clear();
            self.facets[side].clear();
        }
        if !std::mem::replace(&mut self.has_room, true) {
            self.make_room(skins, points, reach)?;
        }
        if is_far {
            return Ok(());
        }
        let clouds = [0, 1].map(|side| Cloud::uniform(&self.centers[side], reach));
        for side in 0..2 {
            self.search.between(
                clouds[side],
                clouds[1 - side],
                0.0,
                &Periodic::NONE,
                &mut self.lists[side],
            )?;
        }
        for side in 0..2 {
            let (skin, list) = (skins[side], &self.lists[side]);
            let near =
                (0..skin.facets.corners.len() as u32).filter(|facet| !list.row(*facet as usize).is_empty());
            self.near.clear();
            self.near.extend(near);
            let count = points as u32;
            let points = self.near.iter().flat_map(|facet| (0..count).map(move |k| (facet * count + k, 0)));
            self.candidates[side].extend(points);
            let vertices = self.near.iter().flat_map(|&facet| skin.corners_of(facet));
            self.facets[side].extend(vertices.flat_map(|&vertex| skin.facets_at(vertex)));
            self.facets[side].sort_unstable();
            self.facets[side].dedup();
        }
        Ok(())
    }

    /// Asks for memory before the bodies meet: each facet may have as many of the other skin near it as it has of its own.
    fn make_room(&mut self, skins: [&Skin; 2], points: usize, reach: f64) -> Result<(), NeighborError> {
        for side in 0..2 {
            let facets = skins[side].facets.corners.len();
            let vertices = 0..skins[side].vertices() as u32;
            let around: usize = vertices.map(|vertex| skins[side].facets_at(vertex).len().pow(2)).sum();
            self.near.reserve(facets);
            self.candidates[side].reserve(facets * points);
            self.facets[side].reserve(around);
            let own = Cloud::uniform(&self.centers[side], reach);
            self.search.between(own, own, 0.0, &Periodic::NONE, &mut self.lists[side])?;
        }
        Ok(())
    }

    /// Centres of the facets of a side; returns how far the vertices of one are from its centre at most, m, and the box around all.
    fn look(&mut self, side: usize, skin: &Skin, view: &SkinView<'_>) -> (f64, Aabb) {
        self.places.clear();
        self.places.extend((0..skin.vertices() as u32).map(|vertex| (vertex, DVec3::ZERO)));
        for_each_block(&mut self.places[..], &mut Vec::new(), &|_, places: &mut [(u32, DVec3)]| {
            places.iter_mut().for_each(|(vertex, place)| *place = view.place(*vertex));
        });
        let (centers, places) = (&mut self.centers[side], &self.places);
        centers.clear();
        let mut largest = 0.0_f64;
        for facet in 0..skin.facets.corners.len() as u32 {
            let ends = || skin.corners_of(facet).iter().map(|&vertex| places[vertex as usize].1);
            let center = ends().sum::<DVec3>() / skin.facets.axes as f64;
            largest = ends().map(|end| end.distance(center)).fold(largest, f64::max);
            centers.push(center);
        }
        (largest, Aabb::around(places.iter().map(|place| place.1)))
    }
}
