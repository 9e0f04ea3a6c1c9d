//! Cells along one axis of a grid.

use std::ops::Range;

use super::periodic::SHIFT;

/// Relative excess of the cell length over half of the radius. It exceeds round-off for positions below 10^8
/// radii, so that the cell length depends on the radius alone.
const ROOM: f64 = 1e-6;

/// A range of coordinates, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisRange {
    pub min: f64,
    pub max: f64,
}

/// A period along an axis, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisPeriod {
    pub start: f64,
    pub length: f64,
}

/// Cells along one axis. Their corners are integer multiples of their length, or integer fractions of a
/// period. The cell of a particle, and the order of cells, are therefore independent of the other particles.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CellAxis {
    /// Start of the period, m; zero on an axis that is not periodic.
    origin: f64,
    /// Number of the first cell, counted from the origin.
    first: i64,
    /// Cells per metre.
    inverse_cell: f64,
    /// 1 / length on a periodic axis, else zero.
    inverse_period: f64,
    /// Bound of the round-off in distances, m.
    round_off: f64,
    /// Number of cells, and number of buckets onto which they are folded.
    pub cells: i64,
    pub buckets: i64,
}

impl CellAxis {
    /// Bound of the round-off in distances between coordinates of a range, m.
    pub fn round_off(range: AxisRange, radius: f64, period: Option<AxisPeriod>) -> f64 {
        let AxisRange { min, max } = range;
        let reach = match period {
            Some(AxisPeriod { start, length }) => (min - start).abs().max((max - start).abs()) + length,
            None => min.abs().max(max.abs()) + radius,
        };
        8.0 * f64::EPSILON * reach
    }

    /// Cells of half of `radius` in a range, or of slightly more in a period.
    pub fn new(range: AxisRange, radius: f64, period: Option<AxisPeriod>, round_off: f64) -> Self {
        let AxisRange { min, max } = range;
        let mut cell = 0.5 * radius * (1.0 + ROOM);
        // Rounding of the cell number must not place two particles within the radius outside the searched
        // cells.
        while cell < 0.5 * (radius + round_off) {
            cell *= 2.0;
        }
        let Some(AxisPeriod { start: origin, length }) = period else {
            let inverse_cell = 1.0 / cell;
            let first = whole(min * inverse_cell);
            let cells = whole(max * inverse_cell).saturating_sub(first).saturating_add(1).max(1);
            return Self { first, inverse_cell, round_off, cells, buckets: 1, ..Self::default() };
        };
        let cells = (length / cell).floor().max(1.0);
        let (inverse_cell, inverse_period) = (cells / length, 1.0 / length);
        Self { origin, first: 0, inverse_cell, inverse_period, round_off, cells: cells as i64, buckets: 1 }
    }

    /// Whether each cell is a bucket of its own, in the same order.
    pub fn is_plain(&self) -> bool {
        self.cells == self.buckets && self.inverse_period == 0.0
    }

    /// A coordinate in units of cells, on an axis that is not periodic.
    #[inline(always)]
    pub fn place(&self, x: f64) -> f64 {
        x * self.inverse_cell - self.first as f64
    }

    /// A length in units of cells, round-off included.
    #[inline(always)]
    pub fn length(&self, radius: f64) -> f64 {
        (radius * (1.0 + 1e-9) + self.round_off) * self.inverse_cell
    }

    /// Bucket of a coordinate, clamped to that of the last cell.
    #[inline(always)]
    pub fn bucket_of(&self, x: f64) -> i64 {
        let cell = self.cell_of(x);
        if self.cells == self.buckets { cell } else { cell % self.buckets }
    }

    /// Whether several cells share a bucket.
    pub fn is_folded(&self) -> bool {
        self.cells != self.buckets
    }

    /// Cell of a coordinate, clamped to the last one.
    #[inline(always)]
    pub fn cell_of(&self, x: f64) -> i64 {
        self.cell(x).clamp(0, self.cells - 1)
    }

    /// Cell of a coordinate, unclamped: outside 0..cells for a coordinate outside the bounds of a bounded
    /// axis.
    #[inline(always)]
    fn cell(&self, x: f64) -> i64 {
        if self.inverse_period > 0.0 {
            let turns = (x - self.origin) * self.inverse_period;
            (((turns - turns.floor()) * self.cells as f64) as i64).min(self.cells - 1)
        } else {
            // Rounding comes before the subtraction, so that it is independent of the first cell.
            whole(x * self.inverse_cell).saturating_sub(self.first)
        }
    }

    /// The cells within a distance, in cells, of a coordinate, on axes that are not periodic.
    #[inline(always)]
    pub fn span(&self, place: f64, reach: f64) -> Range<u32> {
        let last = (self.cells - 1) as f64;
        let (first, end) = (place - reach, place + reach);
        // With this order of the comparison all cells are within NaN.
        let first = if first > 0.0 { first } else { 0.0 };
        let first = if first < last + 1.0 { first } else { last + 1.0 };
        let end = if end < -1.0 { -1.0 } else { end };
        let end = if end < last + 0.25 { end } else { last + 0.25 };
        rounded(first - 0.5)..rounded(end + 0.5)
    }

    /// Buckets of the cells within the radius, m, of the cell of a coordinate, ascending, without duplicates.
    pub fn around(&self, x: f64, radius: f64, found: &mut Vec<i64>) {
        found.clear();
        let (cell, reach) = (self.cell(x), (self.length(radius) - 1e-9).ceil() as i64);
        for near in cell.saturating_sub(reach)..=cell.saturating_add(reach) {
            let near = match near {
                inside if (0..self.cells).contains(&inside) => inside,
                _ if self.inverse_period == 0.0 => continue,
                outside => outside.rem_euclid(self.cells),
            };
            found.push(near % self.buckets);
        }
        found.sort_unstable();
        found.dedup();
    }
}

/// Rounds to the nearest integer from zero to 2^31. Halves may round either way: the cell lost by that is
/// outside the radius, because the search distance includes a margin.
#[inline(always)]
fn rounded(x: f64) -> u32 {
    (x + SHIFT).to_bits() as u32
}

/// The floor function, without a library call.
#[inline(always)]
fn whole(x: f64) -> i64 {
    let whole = x as i64;
    whole - i64::from(x < whole as f64)
}

/// Numbers of buckets along the axes: the numbers of cells, or fewer, so that their product stays
/// proportional to the number of particles.
pub(super) fn fold_into_buckets(axes: &mut [CellAxis; 3], particles: usize) {
    let mut budget = (4 * particles + 64).min(u32::MAX as usize - 2) as i64;
    let mut order = [0, 1, 2];
    order.sort_by_key(|&a| axes[a].cells);
    let mut folded = [1; 3];
    for (done, &a) in order.iter().enumerate() {
        let share = (budget as f64).powf(1.0 / (3 - done) as f64) as i64;
        let mut buckets = axes[a].cells.min(share.max(1));
        if buckets < axes[a].cells {
            // Without a common divisor, a diagonal line of cells visits every bucket before it repeats one.
            while folded.iter().any(|&other| greatest_common_divisor(other, buckets) > 1) {
                buckets -= 1;
            }
            folded[done] = buckets;
        }
        axes[a].buckets = buckets;
        budget /= buckets;
    }
}

fn greatest_common_divisor(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::{CellAxis, fold_into_buckets};

    #[test]
    fn folded_diagonals_meet_every_bucket() {
        for particles in (0..100_000).step_by(37) {
            let mut axes = [CellAxis { cells: 1 << 40, ..CellAxis::default() }; 3];
            fold_into_buckets(&mut axes, particles);
            let buckets = axes.map(|axis| axis.buckets);
            let product: i64 = buckets.iter().product();
            // The diagonal returns to its first bucket after the least common multiple, so no integer up to
            // the largest may divide two of them.
            for divisor in 2..=buckets[0].max(buckets[1]).max(buckets[2]) {
                assert!(buckets.iter().filter(|&b| b % divisor == 0).count() <= 1, "{buckets:?}");
            }
            let budget = 4 * particles as i64 + 64;
            assert!(product <= budget && product > budget / 3, "{buckets:?} for {particles}");
        }
    }
}
