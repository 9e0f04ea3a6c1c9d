//! Uniform grid of cells, particles sorted into them by counting.
//!
//! A cell is as long as the largest pair radius, so that all neighbours are in the 3 x 3 x 3 cells around a particle.
//! Cells map to buckets, at most about twice as many as particles: one to one where the grid is small enough, and
//! folded onto themselves like a torus where a few particles span a huge box. Folding brings candidates that the
//! distance test rejects, never loses one.

use super::{Cloud, Periodic};
use glam::DVec3;
use rayon::prelude::*;

/// Cells along one axis.
#[derive(Debug, Clone, Copy, Default)]
struct Axis {
    origin: f64,
    /// Cells per metre, or per period.
    inverse_cell: f64,
    /// 1 / length on a periodic axis, else zero.
    inverse_period: f64,
    cells: i64,
    buckets: i64,
}

impl Axis {
    fn new(min: f64, max: f64, radius: f64, period: Option<(f64, f64)>) -> Self {
        let (origin, length, reach) = match period {
            Some((start, length)) => (start, length, (min - start).abs().max((max - start).abs()) + length),
            None => (min, max - min, max - min + radius),
        };
        // Rounding of the cell number must not put two particles within the radius two cells apart.
        let cell = radius * (1.0 + 1e-9) + 8.0 * f64::EPSILON * reach;
        if period.is_some() {
            let cells = (length / cell).floor().max(1.0);
            let inverse_period = 1.0 / length;
            Self { origin, inverse_cell: cells, inverse_period, cells: cells as i64, buckets: 1 }
        } else {
            let inverse_cell = 1.0 / cell;
            let cells = (length * inverse_cell).floor() as i64 + 1;
            Self { origin, inverse_cell, inverse_period: 0.0, cells, buckets: 1 }
        }
    }

    /// Cell of a coordinate; outside 0..cells for one outside the box of a bounded axis.
    #[inline]
    fn cell(&self, x: f64) -> i64 {
        if self.inverse_period > 0.0 {
            let turns = (x - self.origin) * self.inverse_period;
            (((turns - turns.floor()) * self.inverse_cell) as i64).min(self.cells - 1)
        } else {
            let cells = (x - self.origin) * self.inverse_cell;
            // Rounded down, without a call of the library.
            let whole = cells as i64;
            whole - i64::from(cells < whole as f64)
        }
    }

    #[inline]
    fn bucket(&self, cell: i64) -> i64 {
        if self.cells == self.buckets { cell } else { cell % self.buckets }
    }

    /// Buckets of a cell and the two beside it, ascending, each once.
    #[inline(always)]
    fn around(&self, cell: i64) -> Few<i64> {
        let mut found = Few::default();
        for near in [cell.saturating_sub(1), cell, cell.saturating_add(1)] {
            let near = match near {
                inside if (0..self.cells).contains(&inside) => inside,
                _ if self.inverse_period == 0.0 => continue,
                outside => outside.rem_euclid(self.cells),
            };
            found.push(self.bucket(near));
        }
        found.sort_and_dedup();
        found
    }
}

/// At most three values.
#[derive(Debug, Clone, Copy, Default)]
struct Few<T> {
    values: [T; 3],
    count: usize,
}

impl<T: Copy + Ord> Few<T> {
    fn push(&mut self, value: T) {
        self.values[self.count] = value;
        self.count += 1;
    }

    fn as_slice(&self) -> &[T] {
        &self.values[..self.count]
    }

    fn sort_and_dedup(&mut self) {
        self.values[..self.count].sort_unstable();
        let mut kept = 0;
        for i in 0..self.count {
            if i == 0 || self.values[i] != self.values[kept - 1] {
                self.values[kept] = self.values[i];
                kept += 1;
            }
        }
        self.count = kept;
    }
}

/// Ranges of particles.
pub(super) struct Ranges {
    ranges: [std::ops::Range<usize>; 27],
    count: usize,
}

impl Ranges {
    #[inline(always)]
    fn push(&mut self, range: std::ops::Range<usize>) {
        self.ranges[self.count] = range;
        self.count += 1;
    }

    #[inline(always)]
    pub(super) fn as_slice(&self) -> &[std::ops::Range<usize>] {
        &self.ranges[..self.count]
    }
}

/// Room behind the last particle, so that four can be read from each.
const PADDING: usize = 3;

/// Source particles in cell order; buffers are kept from one build to the next.
#[derive(Debug, Default)]
pub(super) struct Grid {
    axes: [Axis; 3],
    keys: Vec<u32>,
    /// Particles of bucket b are `starts[b]..starts[b + 1]` of the arrays below.
    starts: Vec<u32>,
    /// Row of the particle; this and the arrays below are longer by [`PADDING`].
    pub(super) rows: Vec<u32>,
    coordinates: [Vec<f64>; 3],
    /// Support radii; empty where not asked for.
    pub(super) supports: Vec<f64>,
}

impl Grid {
    /// Sorts `sources` into cells of at least `radius`. `bounds` holds targets too on periodic axes.
    pub(super) fn build(
        &mut self,
        sources: Cloud<'_>,
        with_supports: bool,
        bounds: (DVec3, DVec3),
        radius: f64,
        periodic: &Periodic,
    ) {
        let count = sources.positions.len();
        for a in 0..3 {
            let period = periodic.axes()[a].then(|| (periodic.min()[a], periodic.lengths()[a]));
            self.axes[a] = Axis::new(bounds.0[a], bounds.1[a], radius, period);
        }
        fold_into_buckets(&mut self.axes, count);
        let [x, y, z] = self.axes;
        let buckets = (x.buckets * y.buckets * z.buckets) as usize;

        self.keys.resize(count, 0);
        let mut keys = std::mem::take(&mut self.keys);
        keys.par_iter_mut()
            .with_min_len(4096)
            .zip(sources.positions)
            .for_each(|(key, p)| *key = self.key(*p));
        self.keys = keys;

        // starts[b + 1] serves as the write position of bucket b and ends as the start of b + 1.
        self.starts.clear();
        self.starts.resize(buckets + 2, 0);
        for &key in &self.keys {
            self.starts[key as usize + 2] += 1;
        }
        for b in 2..self.starts.len() {
            self.starts[b] += self.starts[b - 1];
        }
        self.rows.resize(count, 0);
        for (row, &key) in self.keys.iter().enumerate() {
            let at = &mut self.starts[key as usize + 1];
            self.rows[*at as usize] = row as u32;
            *at += 1;
        }

        for (a, coordinate) in self.coordinates.iter_mut().enumerate() {
            coordinate.resize(count + PADDING, 0.0);
            coordinate[..count]
                .par_iter_mut()
                .with_min_len(4096)
                .zip(&self.rows)
                .for_each(|(x, &row)| *x = sources.positions[row as usize][a]);
        }
        self.supports.clear();
        if with_supports {
            self.supports.extend(self.rows.iter().map(|&row| sources.support_of(row as usize)));
            self.supports.resize(count + PADDING, 0.0);
        }
        self.rows.resize(count + PADDING, 0);
    }

    /// Bucket of a position: where a source is, and a sensible order for targets, which may lie outside.
    #[inline]
    pub(super) fn key(&self, position: DVec3) -> u32 {
        let at = |a: usize| {
            let axis = &self.axes[a];
            axis.bucket(axis.cell(position[a]).clamp(0, axis.cells - 1))
        };
        ((at(2) * self.axes[1].buckets + at(1)) * self.axes[0].buckets + at(0)) as u32
    }

    /// Coordinates of the sorted particles.
    #[inline(always)]
    pub(super) fn coordinates(&self) -> [&[f64]; 3] {
        let [x, y, z] = &self.coordinates;
        [x, y, z]
    }

    /// Ranges of the sorted arrays that hold all sources in the cells around `position`, each once.
    #[inline]
    pub(super) fn around(&self, position: DVec3) -> Ranges {
        let mut ranges = Ranges { ranges: [const { 0..0 }; 27], count: 0 };
        let [x, y, z] = &self.axes;
        let columns = x.around(x.cell(position.x));
        let Some((&first, rest)) = columns.as_slice().split_first() else { return ranges };
        let lines = y.around(y.cell(position.y));
        for &bz in z.around(z.cell(position.z)).as_slice() {
            for &by in lines.as_slice() {
                let line = (bz * y.buckets + by) * x.buckets;
                // Buckets side by side along x are one range.
                let (mut from, mut to) = (first, first);
                for &next in rest {
                    if next != to + 1 {
                        ranges.push(self.range(line + from, line + to));
                        from = next;
                    }
                    to = next;
                }
                ranges.push(self.range(line + from, line + to));
            }
        }
        ranges
    }

    #[inline]
    fn range(&self, first_bucket: i64, last_bucket: i64) -> std::ops::Range<usize> {
        self.starts[first_bucket as usize] as usize..self.starts[last_bucket as usize + 1] as usize
    }
}

/// Numbers of buckets: the cells themselves, or fewer so that their product stays in proportion to the particles.
fn fold_into_buckets(axes: &mut [Axis; 3], particles: usize) {
    let mut room = (2 * particles + 64).min(u32::MAX as usize - 2) as i64;
    let mut order = [0, 1, 2];
    order.sort_by_key(|&a| axes[a].cells);
    let mut folded = Few::default();
    for (done, &a) in order.iter().enumerate() {
        let share = (room as f64).powf(1.0 / (3 - done) as f64) as i64;
        let mut buckets = axes[a].cells.min(share.max(1));
        if buckets < axes[a].cells {
            // Without a common divisor, a diagonal line of cells meets every bucket before it meets one again.
            while folded.as_slice().iter().any(|&other| greatest_common_divisor(other, buckets) > 1) {
                buckets -= 1;
            }
            folded.push(buckets);
        }
        axes[a].buckets = buckets;
        room /= buckets;
    }
}

fn greatest_common_divisor(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::{Axis, fold_into_buckets};

    #[test]
    fn folded_diagonals_meet_every_bucket() {
        for particles in (0..100_000).step_by(37) {
            let mut axes = [Axis { cells: 1 << 40, ..Axis::default() }; 3];
            fold_into_buckets(&mut axes, particles);
            let buckets = axes.map(|axis| axis.buckets);
            let product: i64 = buckets.iter().product();
            // The diagonal returns to its first bucket after the least common multiple: no number up to the largest
            // divides two of them.
            for divisor in 2..=buckets[0].max(buckets[1]).max(buckets[2]) {
                assert!(buckets.iter().filter(|&b| b % divisor == 0).count() <= 1, "{buckets:?}");
            }
            let room = 2 * particles as i64 + 64;
            assert!(product <= room && product > room / 3, "{buckets:?} for {particles}");
        }
    }
}
