//! The two points that are nearest to each of many samples, in vector lanes.

use glam::DVec3;

use crate::parallel::{FourLanes, HotLoop, run_hot};

/// Samples of a cell, in columns, with the two nearest points of each.
#[derive(Default)]
pub(super) struct Samples {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// Fraction of each sample that is inside the region.
    parts: Vec<f64>,
    nearest: Nearest,
}

/// Squared distances of the nearest and second nearest points, and their indices, as numbers for the sake of
/// the lanes.
#[derive(Default)]
struct Nearest {
    first: Vec<f64>,
    second: Vec<f64>,
    first_index: Vec<f64>,
    second_index: Vec<f64>,
}

/// A sample with the two nearest points: squared distance \[m²\] and index of each.
pub(super) struct SampledPoint {
    pub point: DVec3,
    /// Fraction that is inside the region.
    pub part: f64,
    pub first: (f64, usize),
    pub second: (f64, usize),
}

impl Samples {
    pub fn clear(&mut self) {
        let Self { x, y, z, parts, .. } = self;
        [x, y, z, parts].into_iter().for_each(Vec::clear);
    }

    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    #[inline]
    pub fn push(&mut self, point: DVec3, part: f64) {
        self.x.push(point.x);
        self.y.push(point.y);
        self.z.push(point.z);
        self.parts.push(part);
    }

    /// The samples with the nearest ones of `near`. Of points at the same distance the first one counts.
    pub fn among(&mut self, near: &[(DVec3, u32)]) -> impl Iterator<Item = SampledPoint> {
        run_hot(NearestSearch { samples: self, near });
        let Self { x, y, z, parts, nearest } = &*self;
        (0..parts.len()).map(move |k| SampledPoint {
            point: DVec3::new(x[k], y[k], z[k]),
            part: parts[k],
            first: (nearest.first[k], nearest.first_index[k] as usize),
            second: (nearest.second[k], nearest.second_index[k] as usize),
        })
    }
}

struct NearestSearch<'a> {
    samples: &'a mut Samples,
    near: &'a [(DVec3, u32)],
}

impl HotLoop for NearestSearch<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let Samples { x, y, z, nearest: Nearest { first, second, first_index, second_index }, .. } =
            self.samples;
        let count = x.len();
        let (x, y, z) = (&x[..count], &y[..count], &z[..count]);
        for (column, value) in [
            (&mut *first, f64::INFINITY),
            (&mut *second, f64::INFINITY),
            (&mut *first_index, 0.0),
            (&mut *second_index, 0.0),
        ] {
            column.clear();
            column.resize(count, value);
        }
        let (first, second) = (&mut first[..count], &mut second[..count]);
        let (first_index, second_index) = (&mut first_index[..count], &mut second_index[..count]);
        for (n, (point, _)) in self.near.iter().enumerate() {
            let n = n as f64;
            // Without branches, which could not be predicted.
            for k in 0..count {
                let (dx, dy, dz) = (x[k] - point.x, y[k] - point.y, z[k] - point.z);
                let distance = dx * dx + dy * dy + dz * dz;
                let (is_first, is_second) = (distance < first[k], distance < second[k]);
                let (pushed, index) = if is_second { (distance, n) } else { (second[k], second_index[k]) };
                second[k] = if is_first { first[k] } else { pushed };
                second_index[k] = if is_first { first_index[k] } else { index };
                first[k] = if is_first { distance } else { first[k] };
                first_index[k] = if is_first { n } else { first_index[k] };
            }
        }
    }
}
