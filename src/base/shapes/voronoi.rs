//! Volumes and centroids of the Voronoi cells of scattered points inside a region, by sampling.

use glam::DVec3;
use rayon::prelude::*;

use super::region::Region;
use super::tiling::{CellBox, Tiling};
use super::two_nearest::{SampledPoint, Samples};

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
    /// Cell, counted along x, then y, then z, and index of the point, in ascending order.
    sorted: Vec<(u128, u32)>,
}

impl<'a> TileBuckets<'a> {
    fn new(tiling: &'a Tiling, points: &[DVec3]) -> Self {
        let entry = |(n, &point): (usize, &DVec3)| (tiling.number(tiling.index(point)), n as u32);
        let mut sorted: Vec<_> = points.par_iter().enumerate().map(entry).collect();
        sorted.par_sort_unstable();
        Self { tiling, sorted }
    }

    /// The points in cells up to `reach` cells away.
    fn around(&self, cell: [usize; 3], reach: usize) -> impl Iterator<Item = u32> {
        let low = cell.map(|n| n.saturating_sub(reach));
        let high = [0, 1, 2].map(|k| (cell[k] + reach + 1).min(self.tiling.counts[k]));
        (low[2]..high[2]).flat_map(move |z| (low[1]..high[1]).map(move |y| (z, y))).flat_map(move |(z, y)| {
            let [from, to] = [low[0], high[0]].map(|x| self.tiling.number([x, y, z]));
            let start = self.sorted.partition_point(|&(at, _)| at < from);
            self.sorted[start..].iter().take_while(move |&&(at, _)| at < to).map(|&(_, n)| n)
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
        let (mut found, mut buffers) = (Vec::new(), SampleBuffers::default());
        block.cells().for_each(|cell| sampling.add_cell((cell, block.inside), &mut buffers, &mut found));
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

/// The fraction of a sample of the given width that belongs to the nearest point. A sample that the bisecting
/// plane of the two points cuts is divided as if the plane were parallel to one of its faces, so that the
/// error decreases with the square of the sample size.
#[inline]
fn share(sample: &SampledPoint, near: &[(DVec3, u32)], width: f64) -> f64 {
    if !sample.second.0.is_finite() {
        return 1.0;
    }
    let apart = near[sample.first.1].0.distance(near[sample.second.1].0);
    let to_plane = (sample.second.0 - sample.first.0) / (2.0 * apart);
    (0.5 + to_plane / width).min(1.0)
}

/// SampleBuffers of the sampling, kept from cell to cell.
#[derive(Default)]
struct SampleBuffers {
    samples: Samples,
    near: Vec<(DVec3, u32)>,
    sums: Vec<CellMoments>,
}

impl Sampling<'_> {
    /// Adds the contributions of a cell of the tiling to the moments of its points.
    fn add_cell(
        &self,
        (cell, inside): ([usize; 3], bool),
        buffers: &mut SampleBuffers,
        found: &mut Vec<(u32, CellMoments)>,
    ) {
        let Self { buckets, points, .. } = *self;
        let SampleBuffers { samples, near, sums } = buffers;
        self.place(samples, cell, inside);
        if samples.is_empty() {
            return;
        }
        let tiling = buckets.tiling;
        let step = 1.0 / self.samples as f64;
        let width = tiling.cell.max_element() * step;
        let volume = tiling.cell_volume() * step.powi(tiling.axes as i32);
        let safe = (0..tiling.axes).map(|k| tiling.cell[k]).fold(f64::INFINITY, f64::min);
        near.clear();
        near.extend(buckets.around(cell, 1).map(|n| (points[n as usize], n)));
        sums.clear();
        sums.resize(near.len(), CellMoments::default());
        for sample in samples.among(near) {
            let (point, weight) = (sample.point, sample.part * volume);
            // All points within the side of a cell are in the adjacent cells.
            if sample.first.0 > safe * safe {
                let far = nearest_far(buckets, points, cell, point, safe);
                found.push((far, CellMoments { volume: weight, first: weight * point }));
                continue;
            }
            let mut add = |n: usize, weight: f64| {
                sums[n].volume += weight;
                sums[n].first += weight * point;
            };
            let share = share(&sample, near, width);
            add(sample.first.1, share * weight);
            if share < 1.0 {
                add(sample.second.1, (1.0 - share) * weight);
            }
        }
        let reached = near.iter().zip(&*sums).filter(|(_, sum)| sum.volume > 0.0);
        found.extend(reached.map(|(&(_, n), &sum)| (n, sum)));
    }

    /// The samples of a cell that are in the region, at least in part.
    fn place(&self, samples: &mut Samples, cell: [usize; 3], mut inside: bool) {
        samples.clear();
        let tiling = self.buckets.tiling;
        let step = 1.0 / self.samples as f64;
        let width = tiling.cell.max_element() * step;
        if !inside {
            // The distance changes by no more than the way.
            let middle = self.region.distance(tiling.point(cell, DVec3::splat(0.5)));
            let reach = 0.5 * (tiling.cell.length() + width);
            if middle > reach {
                return;
            }
            inside = middle < -reach;
        }
        for z in 0..if tiling.axes == 3 { self.samples } else { 1 } {
            for y in 0..self.samples {
                for x in 0..self.samples {
                    let place = DVec3::new(x as f64, y as f64, z as f64);
                    let point = tiling.point(cell, step * (place + 0.5));
                    let clipped = || (0.5 - self.region.distance(point) / width).clamp(0.0, 1.0);
                    let part = if inside { 1.0 } else { clipped() };
                    if part > 0.0 {
                        samples.push(point, part);
                    }
                }
            }
        }
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
