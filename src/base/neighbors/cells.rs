//! Positions sorted into cells, for algorithms that process nearby particles together.

use glam::DVec3;

use super::{Buckets, Periodic, PointBounds, bounds};

/// Cells of equal length along each axis, with x as the fastest index.
pub struct Cells {
    /// Number of cells along each axis.
    pub counts: [usize; 3],
    /// Minimum length of a cell, m.
    pub length: f64,
}

/// Sorts positions into cells of at least the given length, m. The length is doubled until there are no more
/// cells than particles, as for drops far apart. One cell is centred at the origin for every length, and an
/// integer number of cells fills a periodic axis.
pub fn sort_into_cells(
    cells: &mut Buckets,
    positions: &[DVec3],
    mut length: f64,
    periodic: &Periodic,
) -> Cells {
    let (PointBounds { low, high }, wraps) = (bounds(positions), periodic.axes());
    let number = |x: f64, length: f64| (x / length + 0.5).floor() as i64;
    let counts = loop {
        let counts = [0, 1, 2].map(|a| {
            let last = if wraps[a] {
                (periodic.lengths()[a] / length) as i64 - 1
            } else {
                number(high[a], length).saturating_sub(number(low[a], length))
            };
            last.max(0) as usize + 1
        });
        let product = counts.iter().fold(1_usize, |product, &n| product.saturating_mul(n));
        if product <= positions.len() + 64 {
            break counts;
        }
        length *= 2.0;
    };
    let [nx, ny, nz] = counts;
    let first = [0, 1, 2].map(|a| if wraps[a] { 0 } else { number(low[a], length) });
    let place = |x: DVec3, a: usize| {
        if wraps[a] {
            ((x[a] - periodic.min()[a]) * (counts[a] as f64 / periodic.lengths()[a])) as usize
        } else {
            number(x[a], length).saturating_sub(first[a]).max(0) as usize
        }
    };
    let key = |x: DVec3| {
        let x = if periodic.any() { periodic.wrap(x) } else { x };
        let [i, j, k] = [(0, nx), (1, ny), (2, nz)].map(|(a, n)| place(x, a).min(n - 1));
        ((k * ny + j) * nx + i) as u32
    };
    cells.sort(positions, nx * ny * nz, key);
    Cells { counts, length }
}
