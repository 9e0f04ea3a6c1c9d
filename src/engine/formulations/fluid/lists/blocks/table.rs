//! Which particles are a block: eight that are near each other.
//!
//! The particles of a body are sorted into cells of some spacings, and runs of them are halved along the longest side of their box until eight are left: compact boxes have few
//! neighbours in common. They are rebuilt with the lists. A box stays smaller than the support; where particles are far apart, lanes of a block are left without one.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::neighbors::{Buckets, Periodic, sort_into_cells};
use crate::parallel::EIGHT;

/// Particles that are halved together.
const RUN: usize = 512;
/// Length of a cell over the support: a cell has some sixty particles.
const CELL: f64 = 1.5;

/// Rows of the particles of a block; lanes without a particle repeat the last one.
pub type Rows = [u32; EIGHT];

/// The blocks of all fluids.
#[derive(Debug, Default)]
pub struct BlockTable {
    /// Particles of each block, ascending.
    pub rows: Vec<Rows>,
    /// Where the blocks of each fluid end.
    pub ends: Vec<usize>,
    /// Where each particle is: eight times its block, and its lane.
    places: Vec<u32>,
    /// Middle of the box of each block, m, and half of its edges.
    pub centers: Vec<DVec3>,
    pub halves: Vec<DVec3>,
    cells: Buckets,
    runs: Vec<RunMemory>,
}

/// Memory for a run.
#[derive(Debug, Default)]
struct RunMemory {
    points: Vec<RunPoint>,
    blocks: Vec<Rows>,
}

/// A particle of a run; its place is measured from the first one.
#[derive(Clone, Copy, Debug)]
struct RunPoint {
    x: Vec3,
    row: u32,
}

impl BlockTable {
    /// Makes the blocks of fluids whose rows end here from the positions of their particles, m, which are finite.
    pub fn build(&mut self, positions: &[DVec3], fluids: &[u32], support: f64, periodic: &Periodic) {
        self.rows.clear();
        self.ends.clear();
        let mut first = 0;
        for end in fluids.iter().map(|&end| end as usize) {
            self.add_fluid(&positions[first..end], first as u32, support, periodic);
            self.ends.push(self.rows.len());
            first = end;
        }
        self.places.resize(first, 0);
        for (block, rows) in self.rows.iter().enumerate() {
            // Backwards, so that a row that is repeated keeps its first lane.
            for lane in (0..EIGHT).rev() {
                self.places[rows[lane] as usize] = (EIGHT * block + lane) as u32;
            }
        }
        self.centers.resize(self.rows.len(), DVec3::ZERO);
        self.halves.resize(self.rows.len(), DVec3::ZERO);
        let boxes = self.centers.par_iter_mut().zip(&mut self.halves).with_min_len(256);
        boxes.zip(&self.rows).for_each(|((center, half), rows)| {
            let origin = positions[rows[0] as usize];
            let (mut low, mut high) = (DVec3::ZERO, DVec3::ZERO);
            for &row in rows {
                let x = periodic.minimal_image(positions[row as usize] - origin);
                (low, high) = (low.min(x), high.max(x));
            }
            (*center, *half) = (origin + 0.5 * (low + high), 0.5 * (high - low));
        });
    }

    fn add_fluid(&mut self, positions: &[DVec3], first: u32, support: f64, periodic: &Periodic) {
        let Self { rows, cells, runs, .. } = self;
        sort_into_cells(cells, positions, CELL * support, periodic);
        let sorted = &cells.rows;
        let count = positions.len().div_ceil(RUN);
        runs.resize_with(runs.len().max(count), RunMemory::default);
        runs[..count].par_iter_mut().zip(sorted.par_chunks(RUN)).for_each(|(run, sorted)| {
            let RunMemory { points, blocks } = run;
            let origin = positions[sorted[0] as usize];
            let point = |&row: &u32| {
                let x = periodic.minimal_image(positions[row as usize] - origin);
                RunPoint { x: x.as_vec3(), row: first + row }
            };
            points.clear();
            points.extend(sorted.iter().map(point));
            blocks.clear();
            halve(points, support as f32, blocks);
        });
        runs[..count].iter().for_each(|run| rows.extend_from_slice(&run.blocks));
    }

    /// Number of particles.
    pub fn particles(&self) -> usize {
        self.places.len()
    }

    /// Block and lane of a particle.
    #[inline(always)]
    pub fn place(&self, row: usize) -> (usize, usize) {
        let place = self.places[row] as usize;
        (place / EIGHT, place % EIGHT)
    }

    /// The blocks of the fluid of that number.
    pub fn of_fluid(&self, n: usize) -> std::ops::Range<usize> {
        (if n == 0 { 0 } else { self.ends[n - 1] })..self.ends[n]
    }

    /// The blocks of each fluid.
    pub fn fluids(&self) -> impl Iterator<Item = std::ops::Range<usize>> + Clone {
        (0..self.ends.len()).map(|n| self.of_fluid(n))
    }
}

/// Halves points until eight are left, in a box of edges up to `limit`, m.
fn halve(points: &mut [RunPoint], limit: f32, blocks: &mut Vec<Rows>) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for point in &*points {
        (low, high) = (low.min(point.x), high.max(point.x));
    }
    let extent = high - low;
    let longest = extent.max_element();
    if points.len() <= EIGHT && longest <= limit {
        points.sort_unstable_by_key(|point| point.row);
        let last = points.len() - 1;
        blocks.push(std::array::from_fn(|lane| points[lane.min(last)].row));
        return;
    }
    let axis = (0..3).find(|&axis| extent[axis] == longest).unwrap_or(0);
    let half = points.len() / 2;
    let middle = if points.len() > EIGHT { half.next_multiple_of(EIGHT).min(points.len() - 1) } else { half };
    points.select_nth_unstable_by(middle, |a, b| a.x[axis].total_cmp(&b.x[axis]).then(a.row.cmp(&b.row)));
    let (left, right) = points.split_at_mut(middle);
    halve(left, limit, blocks);
    halve(right, limit, blocks);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lattice of 12 x 12 x 12 at a spacing of 1 with some disorder, and two particles far away.
    fn places() -> Vec<DVec3> {
        let along = |k: usize| DVec3::new((k % 12) as f64, (k / 12 % 12) as f64, (k / 144) as f64);
        let off = |k: usize| {
            0.1 * DVec3::new((0.7 * k as f64).sin(), (1.3 * k as f64).sin(), (2.9 * k as f64).sin())
        };
        let lattice = (0..1728).map(|k| along(k) + off(k));
        lattice.chain([DVec3::new(900.0, 3.0, 4.0), DVec3::new(-1e6, 3.0, 4.0)]).collect()
    }

    #[test]
    fn every_particle_has_one_place_in_a_compact_block_of_its_body() {
        let (positions, mut table) = (places(), BlockTable::default());
        table.build(&positions, &[700, 1730], 2.6, &Periodic::NONE);
        for row in 0..positions.len() {
            let (block, lane) = table.place(row);
            assert_eq!(table.rows[block][lane] as usize, row);
            assert!(table.of_fluid(usize::from(row >= 700)).contains(&block));
        }
        let longest = |half: &DVec3| 2.0 * half.max_element();
        assert!(table.halves.iter().all(|half| longest(half) <= 2.6 + 1e-6));
        let mean = table.halves.iter().map(longest).sum::<f64>() / table.rows.len() as f64;
        assert!(mean < 2.0 && table.rows.len() < 1730 / 6, "{mean} {}", table.rows.len());
        // Each box holds its particles.
        for (block, rows) in table.rows.iter().enumerate() {
            let beyond =
                |&row: &u32| (positions[row as usize] - table.centers[block]).abs() - table.halves[block];
            assert!(rows.iter().map(beyond).all(|beyond| beyond.max_element() < 1e-9));
        }
    }
}
