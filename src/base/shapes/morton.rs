//! Order along a space-filling curve: neighbours in space become neighbours in memory.

use glam::DVec3;
use rayon::prelude::*;

/// Bits of a key for each axis.
const BITS: u32 = 21;
/// Cells on either side of the origin of the grid.
const HALF: f64 = (1 << (BITS - 1)) as f64;

/// Order along a Morton (Z-order) curve, with persistent buffers.
#[derive(Debug, Default)]
pub struct MortonSort {
    keys: Vec<(u64, u32)>,
    order: Vec<u32>,
}

impl MortonSort {
    /// The order of `points` along the curve through a grid of cells of side `cell` \[m\] with its origin at
    /// `around` \[m\]: element n is the index of the n-th point. The order of points within a cell is
    /// preserved. Where 2^20 cells on either side do not suffice, their side is doubled until they do.
    pub fn order(&mut self, points: &[DVec3], around: DVec3, mut cell: f64) -> &[u32] {
        let farthest = points
            .iter()
            .fold(0.0_f64, |farthest, &point| farthest.max((point - around).abs().max_element()));
        while farthest / cell >= HALF - 1.0 {
            cell *= 2.0;
        }
        // Points of a lattice that starts at `around` are half a cell away from the faces of the cells, so
        // that round-off cannot move them across.
        let index = |x: f64| (x / cell + (HALF + 0.5)) as u64;
        let key = |point: DVec3| {
            let from = point - around;
            spread(index(from.x)) | spread(index(from.y)) << 1 | spread(index(from.z)) << 2
        };
        self.keys.clear();
        self.keys.par_extend(points.par_iter().enumerate().map(|(n, &point)| (key(point), n as u32)));
        self.keys.par_sort_unstable();
        self.order.clear();
        self.order.extend(self.keys.iter().map(|&(_, n)| n));
        &self.order
    }
}

/// [`MortonSort::order`] without persistent buffers, with the origin at the minimum corner of the points.
pub fn morton_order(points: &[DVec3], cell: f64) -> Vec<u32> {
    let first = points.first().copied().unwrap_or_default();
    let corner = points.iter().fold(first, |corner, &point| corner.min(point));
    let mut sort = MortonSort::default();
    sort.order(points, corner, cell);
    sort.order
}

/// The 21 lowest bits, spread to every third bit.
fn spread(bits: u64) -> u64 {
    let mut x = bits & 0x1f_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}
