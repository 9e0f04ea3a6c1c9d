//! Irregular packings: random points made uniform by Lloyd's method, with Voronoi volumes.

use std::collections::HashMap;

use glam::DVec3;

use super::region::Region;
use super::site::{Content, Site};
use super::tiling::{CellBox, Tiling};
use super::voronoi::{self, CellMoments};

/// Minimum distance of random points at the start \[spacings\].
const SEPARATION: f64 = 0.6;
/// Failed draws per requested point, after which the minimum distance is lowered.
const PATIENCE: usize = 200;
/// Samples along each side of a cell in two and three dimensions, for a step of Lloyd's method and for the
/// volumes.
const STEP_SAMPLES: [usize; 2] = [6, 3];
const VOLUME_SAMPLES: [usize; 2] = [12, 6];

/// About `volume / spacing^d` irregular particles in `region`: random points with a minimum distance, moved
/// `iterations` times to the centroids of their Voronoi cells (Lloyd, IEEE Trans. Inf. Theory 28, 1982). Each
/// has the volume of its cell; the sum of volumes is `volume`. The cost is proportional to the number of
/// particles.
pub(super) fn sites(content: Content<'_>, seed: u64, iterations: u32) -> Vec<Site> {
    let Content { region, volume, spacing, axes } = content;
    let bounds = region.bounds();
    let tiling = Tiling::new(&bounds, &bounds, DVec3::splat(spacing), axes);
    let count = (volume / spacing.powi(axes as i32)).round().max(1.0) as usize;
    let mut points = scatter(region, &tiling, count, spacing, seed);
    for _ in 0..iterations {
        let moments = voronoi::moments(region, &tiling, &points, STEP_SAMPLES[axes - 2]);
        for (point, cell) in points.iter_mut().zip(moments) {
            let centroid = cell.first / cell.volume;
            // The centroid of a non-convex cell at a hole or a notch may be outside.
            if cell.volume > 0.0 && region.contains(centroid) {
                *point = centroid;
            }
        }
    }
    let moments = voronoi::moments(region, &tiling, &points, VOLUME_SAMPLES[axes - 2]);
    let factor = volume / moments.iter().map(|cell| cell.volume).sum::<f64>();
    let site = |(position, cell): (DVec3, CellMoments)| Site { position, volume: cell.volume * factor };
    points.into_iter().zip(moments).map(site).filter(|site| site.volume > 0.0).collect()
}

/// `count` random points in the region, no two closer than `SEPARATION` spacings while such points can be
/// found.
fn scatter(region: &dyn Region, tiling: &Tiling, count: usize, spacing: f64, seed: u64) -> Vec<DVec3> {
    let blocks = tiling.blocks(region, 1, 1);
    // The map is only used for look-ups, so its order has no influence.
    let mut taken: HashMap<[usize; 3], Vec<DVec3>> = HashMap::new();
    let mut random = SplitMix(seed);
    let mut points: Vec<DVec3> = Vec::with_capacity(count);
    let mut separation = SEPARATION * spacing;
    let mut failed = 0;
    while points.len() < count {
        let cell = blocks[(random.unit() * blocks.len() as f64) as usize].low;
        let point = tiling.point(cell, DVec3::new(random.unit(), random.unit(), random.unit()));
        let low = cell.map(|n| n.saturating_sub(1));
        let high = [0, 1, 2].map(|k| (cell[k] + 2).min(tiling.counts[k]));
        let close = |other: &DVec3| other.distance_squared(point) < separation * separation;
        let crowded = |cell| taken.get(&cell).is_some_and(|others| others.iter().any(close));
        if region.distance(point) < 0.0 && !(CellBox { low, high, inside: false }).cells().any(crowded) {
            taken.entry(cell).or_default().push(point);
            points.push(point);
            continue;
        }
        failed += 1;
        if failed > PATIENCE * count {
            separation *= 0.9;
            failed = 0;
        }
    }
    points
}

/// The generator SplitMix64 (Steele, Lea and Flood, OOPSLA 2014): the same numbers on every machine.
struct SplitMix(u64);

impl SplitMix {
    /// The next number, uniformly distributed in 0 <= x < 1.
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 * 2f64.powi(-53)
    }
}
