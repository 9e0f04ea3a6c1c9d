//! Candidates of contact: pairs within reach and a skin, searched again when the bodies may have moved by the
//! skin.
//!
//! The search covers the particles near the common part of the boxes around two bodies. The list contains
//! every pair in contact, however old it is, so that results do not depend on its age.

use glam::DVec3;

use crate::contact::active::Filter;
use crate::contact::response::PairKey;
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic, SupportRadii};
use crate::parallel::{BlockSum, for_each_block, sum_over_blocks};
use crate::shapes::Aabb;
use crate::symmetry::Map;
use crate::world::Position;

/// Skin over the distance of two particles that just touch.
const SKIN: f64 = 0.5;

/// Places of the particles of a body.
#[derive(Clone, Copy)]
pub(super) struct ContactParticles<'a> {
    pub position: &'a [Position],
    /// Radius of every particle, m.
    pub radius: &'a [f64],
    /// The image of the body that is looked at.
    pub mirror: Map,
}

/// Candidates of contact between the particles of two bodies, or of one with itself.
pub(super) struct Search {
    skin: f64,
    /// Largest radius on each side, m.
    largest: [f64; 2],
    periodic: Periodic,
    /// How far the two bodies may move together before the list is built again, m; how far they have.
    budget: f64,
    travelled: f64,
    /// How far particles were stretched at most when the list was built.
    stretch: f64,
    regions: [NearRegion; 2],
    search: NeighborSearch,
    list: NeighborList,
    pairs: Vec<PairKey>,
}

/// The particles of a body that are near the other one.
struct NearRegion {
    filter: Filter<u32, ()>,
    numbers: Vec<u32>,
    position: Vec<DVec3>,
    reach: Vec<f64>,
}

impl NearRegion {
    /// With capacity for that many particles.
    fn of(particles: usize) -> Self {
        let (numbers, position) = (Vec::with_capacity(particles), Vec::with_capacity(particles));
        Self { filter: Filter::new(particles), numbers, position, reach: Vec::with_capacity(particles) }
    }

    fn collect(&mut self, crowd: ContactParticles<'_>, stretch: f64, within: Option<&Aabb>) {
        let Self { filter, numbers, position, reach } = self;
        let place = |k: usize| crowd.mirror.place(crowd.position[k].0);
        filter.select(crowd.position.len(), numbers, &|k, ()| {
            let x = place(k);
            let is_near = within.is_none_or(|within| x.cmpge(within.min).all() && x.cmple(within.max).all());
            is_near.then_some(k as u32)
        });
        position.resize(numbers.len(), DVec3::ZERO);
        reach.resize(numbers.len(), 0.0);
        let rows = (&numbers[..], &mut position[..], &mut reach[..]);
        type Rows<'a> = (&'a [u32], &'a mut [DVec3], &'a mut [f64]);
        for_each_block(rows, &mut Vec::new(), &|_, (numbers, position, reach): Rows<'_>| {
            for ((&k, position), reach) in numbers.iter().zip(position).zip(reach) {
                *position = place(k as usize);
                *reach = 2.0 * stretch * crowd.radius[k as usize];
            }
        });
    }

    fn cloud(&self) -> Cloud<'_> {
        Cloud { positions: &self.position, support: SupportRadii::PerParticle(&self.reach) }
    }
}

impl Search {
    /// A search between particles of these radii, with capacity for so many pairs.
    pub fn new(first: &[f64], second: &[f64], periodic: Periodic, capacity: usize) -> Self {
        let largest = [first, second].map(|radius| radius.iter().copied().fold(0.0, f64::max));
        Self {
            skin: SKIN * (largest[0] + largest[1]),
            largest,
            periodic,
            budget: -1.0,
            travelled: 0.0,
            stretch: 1.0,
            regions: [first, second].map(|radius| NearRegion::of(radius.len())),
            search: NeighborSearch::default(),
            list: NeighborList::default(),
            pairs: Vec::with_capacity(capacity),
        }
    }

    /// Takes in how far the two bodies may have moved together, m, and how far their particles are stretched
    /// at most, and says whether the list has to be built again. It is then built for this stretch.
    pub fn moved(&mut self, distance: f64, stretch: f64) -> bool {
        self.travelled += distance;
        let grown = (self.largest[0] + self.largest[1]) * (stretch - self.stretch).max(0.0);
        let used = self.travelled + grown;
        // A distance that is not a number must not keep an old list.
        let is_old = used.is_nan() || used > self.budget;
        if is_old {
            self.stretch = stretch;
        }
        is_old
    }

    /// Has the list built again.
    pub fn forget(&mut self) {
        self.budget = -1.0;
    }

    /// Minimum period with which each particle sees one image of another, m.
    pub fn min_period(&self) -> f64 {
        2.0 * (self.largest[0] + self.largest[1] + self.skin)
    }

    /// The pairs that may touch, ascending.
    pub fn pairs(&self) -> &[PairKey] {
        &self.pairs
    }

    /// Finds the pairs of two bodies.
    pub fn between(
        &mut self,
        first: ContactParticles<'_>,
        second: ContactParticles<'_>,
    ) -> Result<(), NeighborError> {
        self.pairs.clear();
        self.travelled = 0.0;
        let reach = self.stretch * (self.largest[0] + self.largest[1]);
        let boxes = [first, second].map(|crowd| self.around(crowd));
        let gap = (boxes[0].min - boxes[1].max).max(boxes[1].min - boxes[0].max).max(DVec3::ZERO).length();
        self.budget = self.skin.max(gap - reach);
        if gap >= reach + self.skin {
            return Ok(());
        }
        let margin = DVec3::splat(reach + self.skin);
        for (k, crowd) in [first, second].into_iter().enumerate() {
            let other = boxes[1 - k];
            let within = Aabb { min: other.min - margin, max: other.max + margin };
            self.regions[k].collect(crowd, self.stretch, Some(&within));
        }
        let [targets, sources] = &self.regions;
        if targets.numbers.is_empty() || sources.numbers.is_empty() {
            return Ok(());
        }
        let list = &mut self.list;
        self.search.between(targets.cloud(), sources.cloud(), self.skin, &self.periodic, list)?;
        for (k, &i) in targets.numbers.iter().enumerate() {
            self.pairs.extend(self.list.row(k).iter().map(|&j| (i, sources.numbers[j as usize])));
        }
        Ok(())
    }

    /// Finds the pairs of a body with itself, or with an image of itself, that `apart` accepts, the smaller
    /// number first. A particle may touch its own image.
    pub fn of_itself(
        &mut self,
        own: ContactParticles<'_>,
        other: ContactParticles<'_>,
        apart: impl Fn(u32, u32) -> bool,
    ) -> Result<(), NeighborError> {
        let mirrored = other.mirror != Map::IDENTITY;
        if mirrored {
            self.between(own, other)?;
            self.pairs.retain(|&(i, j)| i <= j && apart(i, j));
            return Ok(());
        }
        self.pairs.clear();
        self.travelled = 0.0;
        self.budget = self.skin;
        self.regions[0].collect(own, self.stretch, None);
        self.search.within(self.regions[0].cloud(), self.skin, &self.periodic, &mut self.list)?;
        for i in 0..own.position.len() as u32 {
            let others = self.list.row(i as usize).iter().filter(|&&j| i < j && apart(i, j));
            self.pairs.extend(others.map(|&j| (i, j)));
        }
        Ok(())
    }

    /// The box around particles; periodic axes have no end.
    fn around(&self, crowd: ContactParticles<'_>) -> Aabb {
        let mirror = crowd.mirror;
        let bounds = sum_over_blocks(crowd.position, &|_, rows: &[Position]| {
            let places = rows.iter().map(|x| mirror.place(x.0));
            places.fold(ContactBounds::default(), |bounds, x| ContactBounds(bounds.0.min(x), bounds.1.max(x)))
        });
        let mut around = Aabb { min: bounds.0, max: bounds.1 };
        for axis in (0..3).filter(|&axis| self.periodic.axes()[axis]) {
            (around.min[axis], around.max[axis]) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        around
    }
}

#[derive(Clone, Copy)]
struct ContactBounds(DVec3, DVec3);

impl Default for ContactBounds {
    fn default() -> Self {
        Self(DVec3::INFINITY, DVec3::NEG_INFINITY)
    }
}

impl BlockSum for ContactBounds {
    fn add(&mut self, next: &Self) {
        *self = Self(self.0.min(next.0), self.1.max(next.1));
    }
}
