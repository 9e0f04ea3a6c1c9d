//! Uniform grid of cells, into which particles are sorted by counting.
//!
//! A cell is half as long as the largest pair radius. Cells map to buckets, of which there are at most about
//! four per particle. The map is one to one where the grid is small enough; where a few particles span a huge
//! box, the cells are folded onto a torus. Folding adds candidates that the distance test rejects, never
//! loses one, and preserves the order of neighbours.

use glam::DVec3;
use rayon::prelude::*;

use super::axis::{AxisPeriod, AxisRange, CellAxis, fold_into_buckets};
use super::buckets::Buckets;
use super::{Cloud, Periodic, PointBounds};

/// Padding behind the last particle, so that four can be read from each.
const PADDING: usize = 3;

/// Source particles in cell order; buffers are reused from one build to the next.
#[derive(Debug, Default)]
pub(super) struct Grid {
    axes: [CellAxis; 3],
    /// Whether each cell is a bucket of its own along each axis.
    plain: bool,
    buckets: Buckets,
    coordinates: [Vec<f64>; 3],
    /// Support radii; empty where all are equal.
    pub supports: Vec<f64>,
    /// Cell indices z, y, x of all sources, in the order of rows; empty where no bucket holds several cells.
    cells: Vec<[i64; 3]>,
}

/// A contiguous range of the sorted particles.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellRun {
    pub first: u32,
    pub end: u32,
    /// Whether the particle at the centre of the search may be in the range.
    pub holds_own: bool,
}

/// Ranges of the sorted particles, and the scratch memory of the search for them.
#[derive(Debug, Default)]
pub(super) struct Ranges {
    pub found: Vec<CellRun>,
    /// Number of particles, the padding to multiples of four included.
    pub padded_len: usize,
    lists: [Vec<i64>; 3],
}

/// Bounds and radius of a grid.
#[derive(Clone, Copy)]
pub(super) struct GridBounds<'a> {
    /// Bounding box of the searched particles, m.
    pub bounds: PointBounds,
    /// Maximum distance of neighbours, m.
    pub radius: f64,
    pub periodic: &'a Periodic,
}

impl Grid {
    /// Sorts `sources` into cells of half of `radius`. `bounds` includes the targets on periodic axes; the
    /// number of buckets is proportional to `particles`.
    pub fn build(
        &mut self,
        sources: Cloud<'_>,
        with_supports: bool,
        around: GridBounds<'_>,
        particles: usize,
    ) {
        let GridBounds { bounds: PointBounds { low, high }, radius, periodic } = around;
        let count = sources.positions.len();
        let period = |a: usize| {
            periodic.axes()[a].then(|| AxisPeriod { start: periodic.min()[a], length: periodic.lengths()[a] })
        };
        let range = |a: usize| AxisRange { min: low[a], max: high[a] };
        let round_off = |a: usize| CellAxis::round_off(range(a), radius, period(a));
        // Cells have the same length along all axes that are not periodic.
        let round_off = round_off(0).max(round_off(1)).max(round_off(2));
        self.axes = [0, 1, 2].map(|a| CellAxis::new(range(a), radius, period(a), round_off));
        fold_into_buckets(&mut self.axes, particles);
        self.plain = self.axes.iter().all(CellAxis::is_plain);
        let [x, y, z] = self.axes;
        let key = |p: DVec3| {
            ((z.bucket_of(p.z) * y.buckets + y.bucket_of(p.y)) * x.buckets + x.bucket_of(p.x)) as u32
        };
        self.buckets.sort(sources.positions, (x.buckets * y.buckets * z.buckets) as usize, key);
        self.cells.clear();
        if self.axes.iter().any(CellAxis::is_folded) {
            self.cells
                .extend(sources.positions.iter().map(|p| [z.cell_of(p.z), y.cell_of(p.y), x.cell_of(p.x)]));
        }

        let rows = &mut self.buckets.rows;
        for (a, coordinate) in self.coordinates.iter_mut().enumerate() {
            coordinate.resize(count + PADDING, 0.0);
            coordinate[..count]
                .par_iter_mut()
                .with_min_len(4096)
                .zip(&*rows)
                .for_each(|(x, &row)| *x = sources.positions[row as usize][a]);
        }
        self.supports.clear();
        if with_supports {
            self.supports.extend(rows.iter().map(|&row| sources.support_of(row as usize)));
            self.supports.resize(count + PADDING, 0.0);
        }
        rows.resize(count + PADDING, 0);
    }

    /// Rows of the sorted particles; they, the coordinates and the support radii are longer by [`PADDING`].
    #[inline(always)]
    pub fn rows(&self) -> &[u32] {
        &self.buckets.rows
    }

    /// Coordinates of the sorted particles.
    #[inline(always)]
    pub fn coordinates(&self) -> [&[f64]; 3] {
        let [x, y, z] = &self.coordinates;
        [x, y, z]
    }

    /// Sorts the sources found by cell and then by row. They are in this order already unless buckets hold
    /// several cells.
    #[inline(never)]
    pub fn order(&self, found: &mut [u32]) {
        if !self.cells.is_empty() {
            found.sort_unstable_by_key(|&row| (self.cells[row as usize], row));
        }
    }

    /// Finds ranges that contain all sources within the radius, m, of `position`, without duplicates.
    #[inline(always)]
    pub fn around(&self, position: DVec3, radius: f64, ranges: &mut Ranges) {
        ranges.clear();
        if !self.plain {
            return self.around_folded(position, radius, ranges);
        }
        let [x, y, z] = &self.axes;
        let at = DVec3::new(x.place(position.x), y.place(position.y), z.place(position.z));
        let reach = x.length(radius);
        let starts = self.buckets.starts();
        let planes = z.span(at.z, reach);
        let lines = y.span(at.y, reach);
        for plane in planes {
            let gap = square_of_gap(plane, at.z);
            for line in lines.clone() {
                let gap = gap + square_of_gap(line, at.y);
                let square = reach * reach - gap;
                if square < 0.0 {
                    continue;
                }
                let columns = x.span(at.x, square.sqrt());
                let line = (plane as usize * y.buckets as usize + line as usize) * x.buckets as usize;
                let (first, end) = (line + columns.start as usize, line + columns.end as usize);
                ranges.add(starts[first], starts[end], gap == 0.0);
            }
        }
    }

    /// The same search where cells adjoin across a period or share buckets.
    fn around_folded(&self, position: DVec3, radius: f64, ranges: &mut Ranges) {
        let [x, y, _] = &self.axes;
        let mut lists = std::mem::take(&mut ranges.lists);
        for (a, list) in lists.iter_mut().enumerate() {
            self.axes[a].around(position[a], radius, list);
        }
        let starts = self.buckets.starts();
        let [columns, lines, planes] = &lists;
        for plane in planes {
            for line in lines {
                let line = ((plane * y.buckets + line) * x.buckets) as usize;
                // Adjacent buckets along x form one range.
                for run in columns.chunk_by(|a, b| a + 1 == *b) {
                    let (first, last) = (line + run[0] as usize, line + run[run.len() - 1] as usize);
                    ranges.add(starts[first], starts[last + 1], true);
                }
            }
        }
        ranges.lists = lists;
    }
}

impl Ranges {
    #[inline(always)]
    fn clear(&mut self) {
        self.found.clear();
        self.padded_len = 0;
    }

    #[inline(always)]
    fn add(&mut self, first: u32, end: u32, holds_own: bool) {
        if first < end {
            self.found.push(CellRun { first, end, holds_own });
            self.padded_len += (end - first) as usize + PADDING + 1;
        }
    }
}

/// Squared distance of a point from a cell, in cells.
#[inline(always)]
fn square_of_gap(cell: u32, place: f64) -> f64 {
    let low = f64::from(cell);
    let (below, above) = (low - place, place - (low + 1.0));
    // `max` is avoided, because it treats NaN separately.
    let gap = if below > above { below } else { above };
    let gap = if gap > 0.0 { gap } else { 0.0 };
    gap * gap
}
