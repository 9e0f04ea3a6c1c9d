//! Images of particles: mirrored across symmetry planes, shifted along periodic axes.
//!
//! An image is one more row behind the real ones. Bonds may lead to it; every step it takes place and pair stress from its
//! source, through the map x -> S x + c with a diagonal S of signs: A -> S A S. Its force is nobody's business.

use std::ops::Range;

use glam::DVec3;

use super::frame::{Frame, frame_of};
use super::rows::{PairStress, Site};
use crate::parallel::{Lanes4, for_each_block};
use crate::world::BodySet;

/// A symmetry plane of some bodies; the condition `Symmetry` adds it.
pub(crate) struct MirrorPlane {
    /// Axis that the plane is normal to.
    pub axis: usize,
    /// Coordinate of the plane, m.
    pub at: f64,
    /// Bodies that it cuts.
    pub bodies: BodySet,
}

/// What a body repeats itself by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Repeat {
    /// A mirror plane at a coordinate, m.
    Mirror { axis: usize, at: f64 },
    /// A period, m, of a body that fills it from `min` on.
    Period { axis: usize, min: f64, length: f64 },
}

/// The map x -> S x + c.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Map {
    signs: DVec3,
    shift: DVec3,
}

impl Map {
    const IDENTITY: Self = Self { signs: DVec3::ONE, shift: DVec3::ZERO };

    fn mirror(axis: usize, at: f64) -> Self {
        let mut map = Self::IDENTITY;
        map.signs[axis] = -1.0;
        map.shift[axis] = 2.0 * at;
        map
    }

    fn shift(axis: usize, by: f64) -> Self {
        let mut map = Self::IDENTITY;
        map.shift[axis] = by;
        map
    }

    fn after(self, first: Self) -> Self {
        Self { signs: self.signs * first.signs, shift: self.signs * first.shift + self.shift }
    }

    fn apply(self, x: DVec3) -> DVec3 {
        self.signs * x + self.shift
    }
}

/// The images of all total-Lagrangian bodies; image k is row `rows + k`.
#[derive(Debug, Default)]
pub struct Images {
    /// Number of real rows.
    rows: usize,
    sources: Vec<u32>,
    /// Index of the map of each image.
    which: Vec<u32>,
    maps: Vec<Map>,
}

impl Images {
    /// No images yet of a phase of that many rows.
    pub(super) fn new(rows: usize) -> Self {
        Self { rows, ..Self::default() }
    }

    /// Number of images.
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    /// Whether there is no image.
    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    /// The real row behind a row.
    #[inline]
    pub fn source(&self, row: usize) -> usize {
        if row < self.rows { row } else { self.sources[row - self.rows] as usize }
    }

    /// Signs of the axes of a row that is a mirror image: its vectors are those of its source times the signs. `None` for
    /// all other rows.
    #[inline]
    pub fn mirror(&self, row: usize) -> Option<DVec3> {
        let signs = (row >= self.rows).then(|| self.map(row).signs)?;
        (signs != DVec3::ONE).then_some(signs)
    }

    fn map(&self, row: usize) -> &Map {
        &self.maps[self.which[row - self.rows] as usize]
    }

    /// x_ij from a real row to any row, from the positions of the real rows. Seen from the other end of the bond it is the
    /// same to the last bit, but for signs: the weight is rounded to single precision and must not differ.
    #[inline]
    pub(super) fn pair(&self, position: &[DVec3], i: usize, j: usize) -> DVec3 {
        if j < self.rows {
            return position[j] - position[i];
        }
        let map = self.map(j);
        (map.signs * position[self.source(j)] - position[i]) + map.shift
    }

    /// Place of an image in the reference configuration, m.
    pub(super) fn place(&self, position: &[DVec3], row: usize) -> DVec3 {
        self.map(row).apply(position[self.source(row)])
    }

    /// Adds the images of a body that are closer than `reach` to what they repeat across; returns their rows.
    pub(super) fn add(
        &mut self,
        rows: Range<usize>,
        position: &[DVec3],
        reach: f64,
        repeats: &[Repeat],
    ) -> Range<usize> {
        let first = self.rows + self.len();
        // What the repeats so far have made of the body: those that follow repeat it, too, which fills the corners.
        let mut all: Vec<(u32, u32)> = Vec::new();
        for repeat in repeats {
            let real = self.intern(Map::IDENTITY);
            let own = rows.clone().map(|row| (u32::try_from(row).unwrap_or(u32::MAX), real));
            let before: Vec<(u32, u32)> = own.chain(all.iter().copied()).collect();
            for (row, which) in before {
                let map = self.maps[which as usize];
                let place = map.apply(position[row as usize]);
                for next in repeat.near(place, reach).into_iter().flatten() {
                    let which = self.intern(next.after(map));
                    all.push((row, which));
                }
            }
        }
        self.sources.extend(all.iter().map(|(row, _)| row));
        self.which.extend(all.iter().map(|(_, which)| which));
        first..self.rows + self.len()
    }

    fn intern(&mut self, map: Map) -> u32 {
        let k = self.maps.iter().position(|known| *known == map).unwrap_or_else(|| {
            self.maps.push(map);
            self.maps.len() - 1
        });
        u32::try_from(k).unwrap_or(u32::MAX)
    }

    /// Fills the sites of the images; `origin` is where reference positions of sites are measured from, m.
    pub(super) fn fill_sites(&self, origin: DVec3, sites: &mut [Site]) {
        let (real, images) = sites.split_at_mut(self.rows);
        let rows = (images, &self.sources[..], &self.which[..]);
        type Rows<'a> = (&'a mut [Site], &'a [u32], &'a [u32]);
        for_each_block(rows, &mut Vec::new(), &|_, (images, sources, which): Rows<'_>| {
            for (image, (&source, &which)) in images.iter_mut().zip(sources.iter().zip(which)) {
                let (site, map) = (&real[source as usize], &self.maps[which as usize]);
                let reference = map.apply(site.reference.xyz() + origin) - origin;
                *image = Site::new(reference, map.signs * site.displacement.xyz(), site.reference.0[3]);
            }
        });
    }

    /// Fills the pair stresses of the images, which have their sites.
    pub(super) fn fill_pair_stress(&self, frames: &[Frame], sites: &[Site], pair_stress: &mut [PairStress]) {
        let (real, images) = pair_stress.split_at_mut(self.rows);
        let rows = (images, &sites[self.rows..], &self.sources[..], &self.which[..]);
        type Rows<'a> = (&'a mut [PairStress], &'a [Site], &'a [u32], &'a [u32]);
        for_each_block(rows, &mut Vec::new(), &|_, (images, sites, sources, which): Rows<'_>| {
            let sources = sources.iter().zip(which);
            for ((image, site), (&source, &which)) in images.iter_mut().zip(sites).zip(sources) {
                let (own, signs) = (&real[source as usize], self.maps[which as usize].signs);
                // A of the source is in the frame already; that of the image needs its mirror image, and then the frame.
                let frame = &frames[frame_of(frames, source as usize)];
                let moved = [frame.gradient.x_axis, frame.gradient.y_axis, frame.gradient.z_axis];
                for (axis, column) in image.columns.iter_mut().enumerate() {
                    let last = own.columns[axis].0[3];
                    let plain = own.columns[axis].xyz() - own.stiffness() * moved[axis];
                    // The last lane is no component of A: the bond stiffness keeps its sign.
                    *column = Lanes4::new(plain * signs * signs[axis], last);
                }
                image.complete(frame, site);
            }
        });
    }
}

impl Repeat {
    pub(super) fn axis(&self) -> usize {
        match *self {
            Self::Mirror { axis, .. } | Self::Period { axis, .. } => axis,
        }
    }

    /// The maps to the images of a place that is within reach of a side.
    fn near(&self, place: DVec3, reach: f64) -> [Option<Map>; 2] {
        match *self {
            Self::Mirror { axis, at } => {
                [((place[axis] - at).abs() < reach).then(|| Map::mirror(axis, at)), None]
            }
            Self::Period { axis, min, length } => [
                (place[axis] - min < reach).then(|| Map::shift(axis, length)),
                (min + length - place[axis] < reach).then(|| Map::shift(axis, -length)),
            ],
        }
    }
}
