//! Order along a space-filling curve: neighbours in space become neighbours in memory.

use glam::DVec3;
use rayon::prelude::*;

/// Bits of a key for each axis.
const BITS: u32 = 21;

/// Order along a Morton (Z-order) curve, with memory that is kept.
#[derive(Debug, Default)]
pub struct MortonSort {
    keys: Vec<(u64, u32)>,
    order: Vec<u32>,
}

impl MortonSort {
    /// The order of `points` along the curve through cells of side `cell` \[m\]: element n is the index of the point that comes
    /// n-th. Points of one cell keep their order. Where 2^21 cells a side do not reach, the cells are taken larger.
    pub fn order(&mut self, points: &[DVec3], cell: f64) -> &[u32] {
        let first = points.first().copied().unwrap_or_default();
        let (min, max) =
            points.iter().fold((first, first), |(min, max), &point| (min.min(point), max.max(point)));
        let largest = ((1u64 << BITS) - 2) as f64;
        let cell = cell.max((max - min).max_element() / largest);
        // Points of a lattice lie half a cell away from the walls of the cells, where round-off cannot move them across.
        let index = |x: f64| ((x / cell + 0.5) as u64).min((1 << BITS) - 1);
        let key = |point: DVec3| {
            let from_min = point - min;
            spread(index(from_min.x)) | spread(index(from_min.y)) << 1 | spread(index(from_min.z)) << 2
        };
        self.keys.clear();
        self.keys.par_extend(points.par_iter().enumerate().map(|(n, &point)| (key(point), n as u32)));
        self.keys.par_sort_unstable();
        self.order.clear();
        self.order.extend(self.keys.iter().map(|&(_, n)| n));
        &self.order
    }
}

/// [`MortonSort::order`] for once.
pub fn morton_order(points: &[DVec3], cell: f64) -> Vec<u32> {
    let mut sort = MortonSort::default();
    sort.order(points, cell);
    sort.order
}

/// The 21 lowest bits, three places apart.
fn spread(bits: u64) -> u64 {
    let mut x = bits & 0x1f_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}
