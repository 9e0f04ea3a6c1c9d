//! Positions sorted into cells, for what wants particles that are near each other together.

use glam::{BVec3, DVec3};

use super::{Buckets, Periodic, bounds};

/// Cells of equal length along each axis, x running fastest.
pub struct Cells {
    /// Number of cells along each axis.
    pub counts: [usize; 3],
    /// Least length of a cell, m.
    pub length: f64,
}

/// Sorts positions into cells of at least that length, m, but not into more cells than there are particles: drops that fly far apart have larger ones. Whole numbers of cells
/// fill periodic axes.
pub fn sort_into_cells(
    cells: &mut Buckets,
    positions: &[DVec3],
    mut length: f64,
    periodic: &Periodic,
) -> Cells {
    let ((low, high), wraps) = (bounds(positions), periodic.axes());
    let lengths = DVec3::select(BVec3::from_array(wraps), periodic.lengths(), high - low).max(DVec3::ZERO);
    let counts = loop {
        let along = |a: usize| (lengths[a] / length).floor() as usize + usize::from(!wraps[a]);
        let counts = [0, 1, 2].map(|a| along(a).max(1));
        let product = counts.iter().fold(1_usize, |product, &n| product.saturating_mul(n));
        if product <= positions.len() + 64 {
            break counts;
        }
        length *= 2.0;
    };
    let [nx, ny, nz] = counts;
    let origin = DVec3::select(BVec3::from_array(wraps), periodic.min(), low);
    let cell = DVec3::from_array(
        [0, 1, 2].map(|a| if wraps[a] { counts[a] as f64 / lengths[a] } else { 1.0 / length }),
    );
    let key = |x: DVec3| {
        let x = if periodic.any() { periodic.wrap(x) } else { x };
        let at = (x - origin) * cell;
        let [i, j, k] = [(at.x, nx), (at.y, ny), (at.z, nz)].map(|(at, n)| (at as usize).min(n - 1));
        ((k * ny + j) * nx + i) as u32
    };
    cells.sort(positions, nx * ny * nz, key);
    Cells { counts, length }
}
