//! Volumes and centroids of the Voronoi cells of scattered points inside a region, by sampling.

use glam::DVec3;
use rayon::prelude::*;

use super::region::Region;
use super::tiling::{CellBox, Tiling};

/// Volume and first moment of a Voronoi cell.
#[derive(Clone, Copy, Default)]
pub(super) struct CellMoments {
    /// Volume \[m³\] (area \[m²\]).
    pub volume: f64,
    /// Integral of the position \[m⁴\] (\[m³\]).
    pub first: DVec3,
}

/// Points sorted by their cell of a tiling. Only occupied cells take memory.
struct TileBuckets<'a> {
    tiling: &'a Tiling,
    /// Cell indices z, y, x and index of the point, in ascending order.
    sorted: Vec<([usize; 3], u32)>,
}

impl<'a> TileBuckets<'a> {
    fn new(tiling: &'a Tiling, points: &[DVec3]) -> Self {
        let entry = |(n, &point): (usize, &DVec3)| {
            let [x, y, z] = tiling.index(point);
            ([z, y, x], n as u32)
        };
        let mut sorted: Vec<_> = points.par_iter().enumerate().map(entry).collect();
        sorted.par_sort_unstable();
        Self { tiling, sorted }
    }

    /// The points in cells up to `reach` cells away.
    fn around(&self, cell: [usize; 3], reach: usize) -> impl Iterator<Item = u32> {
        let low = cell.map(|n| n.saturating_sub(reach));
        let high = [0, 1, 2].map(|k| (cell[k] + reach + 1).min(self.tiling.counts[k]));
        (low[2]..high[2]).flat_map(move |z| (low[1]..high[1]).map(move |y| (z, y))).flat_map(move |(z, y)| {
            let start = self.sorted.partition_point(|&(at, _)| at < [z, y, low[0]]);
            let row = self.sorted[start..].iter().take_while(move |&&(at, _)| at < [z, y, high[0]]);
            row.map(|&(_, n)| n)
        })
    }
}

/// Moments of the Voronoi cells of `points`, clipped at the boundary of `region`; each cell of `tiling` is
/// sampled `samples` times along each axis.
pub(super) fn moments(
    region: &dyn Region,
    tiling: &Tiling,
    points: &[DVec3],
    samples: usize,
) -> Vec<CellMoments> {
    let buckets = TileBuckets::new(tiling, points);
    let sampling = Sampling { region, buckets: &buckets, points, samples };
    let leaf = if tiling.axes == 2 { 8 } else { 4 };
    let blocks = tiling.blocks(region, leaf, leaf);
    let of_block = |block: &CellBox| {
        let mut found = Vec::new();
        block.cells().for_each(|cell| sampling.add_cell(cell, block.inside, &mut found));
        found
    };
    let found: Vec<Vec<(u32, CellMoments)>> = blocks.par_iter().map(of_block).collect();
    let mut moments = vec![CellMoments::default(); points.len()];
    // The sum is in the order of blocks, so that it does not depend on the number of threads.
    for (n, part) in found.into_iter().flatten() {
        moments[n as usize].volume += part.volume;
        moments[n as usize].first += part.first;
    }
    moments
}

/// Bounds and sampling of the cells.
struct Sampling<'a> {
    region: &'a dyn Region,
    buckets: &'a TileBuckets<'a>,
    points: &'a [DVec3],
    /// Samples of a cell of the tiling along each axis.
    samples: usize,
}

/// The two points that are nearest to a sample: squared distance, and index among the near points.
#[derive(Clone, Copy)]
struct Nearest {
    first: (f64, usize),
    second: (f64, usize),
}

impl Nearest {
    fn of(near: &[(DVec3, u32)], point: DVec3) -> Self {
        let mut found = Self { first: (f64::INFINITY, 0), second: (f64::INFINITY, 0) };
        for (n, &(other, _)) in near.iter().enumerate() {
            let distance = other.distance_squared(point);
            if distance < found.first.0 {
                found = Self { first: (distance, n), second: found.first };
            } else if distance < found.second.0 {
                found.second = (distance, n);
            }
        }
        found
    }

    /// The fraction of a sample of the given width that belongs to the nearest point. A sample that the
    /// bisecting plane of the two points cuts is divided as if the plane were parallel to one of its faces,
    /// so that the error decreases with the square of the sample size.
    fn share(&self, near: &[(DVec3, u32)], width: f64) -> f64 {
        if !self.second.0.is_finite() {
            return 1.0;
        }
        let apart = near[self.first.1].0.distance(near[self.second.1].0);
        let to_plane = (self.second.0 - self.first.0) / (2.0 * apart);
        (0.5 + to_plane / width).min(1.0)
    }
}

impl Sampling<'_> {
    /// Adds the contributions of a cell of the tiling to the moments of its points.
    fn add_cell(&self, cell: [usize; 3], inside: bool, found: &mut Vec<(u32, CellMoments)>) {
        let Self { region, buckets, points, samples } = *self;
        let tiling = buckets.tiling;
        let step = 1.0 / samples as f64;
        let width = tiling.cell.max_element() * step;
        let volume = tiling.cell_volume() * step.powi(tiling.axes as i32);
        let safe = (0..tiling.axes).map(|k| tiling.cell[k]).fold(f64::INFINITY, f64::min);
        let near: Vec<(DVec3, u32)> = buckets.around(cell, 1).map(|n| (points[n as usize], n)).collect();
        let mut sums = vec![CellMoments::default(); near.len()];
        let layers = if tiling.axes == 3 { samples } else { 1 };
        let places =
            (0..layers).flat_map(|z| (0..samples).flat_map(move |y| (0..samples).map(move |x| [x, y, z])));
        for place in places {
            let point = tiling.point(cell, step * (DVec3::from_array(place.map(|n| n as f64)) + 0.5));
            let part = if inside { 1.0 } else { (0.5 - region.distance(point) / width).clamp(0.0, 1.0) };
            if part == 0.0 {
                continue;
            }
            let nearest = Nearest::of(&near, point);
            let weight = part * volume;
            // All points within the side of a cell are in the adjacent cells.
            if nearest.first.0 > safe * safe {
                let far = nearest_far(buckets, points, cell, point, safe);
                found.push((far, CellMoments { volume: weight, first: weight * point }));
                continue;
            }
            let mut add = |n: usize, weight: f64| {
                sums[n].volume += weight;
                sums[n].first += weight * point;
            };
            let share = nearest.share(&near, width);
            add(nearest.first.1, share * weight);
            if share < 1.0 {
                add(nearest.second.1, (1.0 - share) * weight);
            }
        }
        found
            .extend(near.iter().zip(sums).filter(|(_, sum)| sum.volume > 0.0).map(|(&(_, n), sum)| (n, sum)));
    }
}

/// The nearest of `points`, searched in rings of cells that expand until no outer point can be nearer.
fn nearest_far(buckets: &TileBuckets, points: &[DVec3], cell: [usize; 3], point: DVec3, safe: f64) -> u32 {
    let widest = buckets.tiling.counts.iter().copied().max().unwrap_or(1);
    let mut best = (f64::INFINITY, 0);
    for reach in 2..=widest.max(2) {
        best = buckets.around(cell, reach).fold((f64::INFINITY, 0), |best, n| {
            let distance = points[n as usize].distance(point);
            if distance < best.0 { (distance, n) } else { best }
        });
        if best.0 <= reach as f64 * safe {
            break;
        }
    }
    best.1
}
