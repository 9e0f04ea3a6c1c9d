//! Which particles are a block: eight that are near each other.
//!
//! The rows of a fluid lie along a space-filling curve. Those that loops take at a time, 64 in sequence, are
//! halved along the longest side of their box until eight are left: the particles of a compact box have most
//! of their neighbours in common, and the sums of a block are those of rows of one loop. Blocks are made with
//! the lists.

use std::ops::Range;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::neighbors::Periodic;
use crate::parallel::{BLOCK, EIGHT, Split};

/// Length of a box over the support, at most; where particles are farther apart, lanes of a block are left
/// without one. The limit is there for the search, which gets longer with the box: the halves of a block have
/// together no fewer pairs than the whole.
const LONGEST: f64 = 2.0;

/// Rows of the particles of a block; lanes without a particle repeat the last one.
pub type Rows = [u32; EIGHT];

/// The blocks of some bodies of a flow, fluids first.
#[derive(Debug, Default)]
pub struct BlockTable {
    /// Particles of each block, ascending.
    pub rows: Vec<Rows>,
    /// Middle of the box of each block, m, and half of its edges.
    pub centers: Vec<DVec3>,
    pub halves: Vec<DVec3>,
    /// Rows of each body, and where its part of `starts` is.
    bodies: Vec<(Range<usize>, usize)>,
    /// For every 64 rows of each body, where their blocks start, and after those of a body where they end.
    starts: Vec<usize>,
    /// Where each particle is: eight times its block, and its lane.
    places: Vec<u32>,
    /// Rows of the particles, block by block, and for every 64 of them a bit for each that is the last of its
    /// block.
    order: Vec<u32>,
    lasts: Vec<u64>,
}

/// A particle; its place is measured from one beside it.
#[derive(Clone, Copy, Debug, Default)]
struct RunPoint {
    x: Vec3,
    row: u32,
}

impl BlockTable {
    /// Makes the blocks of bodies whose rows end here from the positions of their particles, m, which are
    /// finite.
    pub fn build(&mut self, positions: &[DVec3], bodies: &[u32], support: f64, periodic: &Periodic) {
        self.rows.clear();
        self.starts.clear();
        self.bodies.clear();
        let mut first = 0;
        for end in bodies.iter().map(|&end| end as usize) {
            self.bodies.push((first..end, self.starts.len()));
            self.add_body(&positions[first..end], first as u32, support, periodic);
            self.starts.push(self.rows.len());
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

    fn add_body(&mut self, positions: &[DVec3], first: u32, support: f64, periodic: &Periodic) {
        let Self { rows, starts, order, lasts, .. } = self;
        order.resize(positions.len(), 0);
        lasts.resize(positions.len().div_ceil(BLOCK), 0);
        let runs = order.par_chunks_mut(BLOCK).zip(&mut lasts[..]).with_min_len(16);
        runs.zip(positions.par_chunks(BLOCK)).enumerate().for_each(|(n, ((order, lasts), positions))| {
            let mut points = [RunPoint::default(); BLOCK];
            let points = &mut points[..positions.len()];
            let row = first + (n * BLOCK) as u32;
            for (k, point) in points.iter_mut().enumerate() {
                let x = periodic.minimal_image(positions[k] - positions[0]);
                *point = RunPoint { x: x.as_vec3(), row: row + k as u32 };
            }
            *lasts = 0;
            halve(points, (LONGEST * support) as f32, 0, lasts);
            order.iter_mut().zip(points).for_each(|(row, point)| *row = point.row);
        });
        for (run, lasts) in order.chunks(BLOCK).zip(lasts) {
            starts.push(rows.len());
            let mut rest = run;
            while !rest.is_empty() {
                let last = (*lasts >> (run.len() - rest.len())).trailing_zeros() as usize;
                rows.push(std::array::from_fn(|lane| rest[lane.min(last)]));
                rest = &rest[last + 1..];
            }
        }
    }

    /// Rows of each body.
    pub fn bodies(&self) -> impl Iterator<Item = Range<usize>> {
        self.bodies.iter().map(|(rows, _)| rows.clone())
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

    /// Number of blocks of that many bodies, the first ones.
    pub fn of_first_bodies(&self, bodies: usize) -> usize {
        self.bodies.get(bodies).map_or(self.rows.len(), |(_, first)| self.starts[*first])
    }

    /// The blocks that some rows of a body are in.
    #[inline]
    pub fn of_rows(&self, rows: &Range<usize>) -> Range<usize> {
        let starts = self.starts_of(rows);
        starts[0]..starts[starts.len() - 1]
    }

    /// For every 64 rows of a body that some are among, where their blocks start, and where the last end.
    fn starts_of(&self, rows: &Range<usize>) -> &[usize] {
        let n = self.bodies.partition_point(|(body, _)| body.start <= rows.start) - 1;
        let (body, first) = &self.bodies[n];
        let from = (rows.start - body.start) / BLOCK;
        let to = (rows.end - body.start).div_ceil(BLOCK);
        &self.starts[first + from..=first + to]
    }

    /// Slice of data of the blocks of a body, split like its rows.
    pub fn beside<T>(&self, body: &Range<usize>, blocks: T) -> OfBlocks<'_, T> {
        OfBlocks { blocks, rows: body.len(), starts: self.starts_of(body) }
    }
}

/// Data of the blocks of some rows, split like the rows.
pub struct OfBlocks<'a, T> {
    pub blocks: T,
    rows: usize,
    starts: &'a [usize],
}

impl<T: Split> Split for OfBlocks<'_, T> {
    fn rows(&self) -> usize {
        self.rows
    }

    fn split(self, at: usize) -> (Self, Self) {
        let Self { blocks, rows, starts } = self;
        let run = at.div_ceil(BLOCK);
        let (blocks, behind) = blocks.split(starts[run] - starts[0]);
        (
            Self { blocks, rows: at, starts: &starts[..=run] },
            Self { blocks: behind, rows: rows - at, starts: &starts[run..] },
        )
    }
}

/// Halves points, of which some come before these, until eight are left, in a box of edges up to `limit`, m,
/// and writes a bit for the last of each block.
fn halve(points: &mut [RunPoint], limit: f32, before: usize, lasts: &mut u64) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for point in &*points {
        (low, high) = (low.min(point.x), high.max(point.x));
    }
    let extent = high - low;
    let longest = extent.max_element();
    if points.len() <= EIGHT && longest <= limit {
        points.sort_unstable_by_key(|point| point.row);
        *lasts |= 1 << (before + points.len() - 1);
        return;
    }
    let axis = (0..3).find(|&axis| extent[axis] == longest).unwrap_or(0);
    let half = points.len() / 2;
    let middle = if points.len() > EIGHT { half.next_multiple_of(EIGHT).min(points.len() - 1) } else { half };
    points.select_nth_unstable_by(middle, |a, b| a.x[axis].total_cmp(&b.x[axis]).then(a.row.cmp(&b.row)));
    let (left, right) = points.split_at_mut(middle);
    halve(left, limit, before, lasts);
    halve(right, limit, before + middle, lasts);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::morton_order;

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
        let (unsorted, mut table) = (places(), BlockTable::default());
        let order = morton_order(&unsorted[..1728], 1.0);
        let sorted = order.iter().map(|&n| unsorted[n as usize]).chain(unsorted[1728..].iter().copied());
        let positions: Vec<DVec3> = sorted.collect();
        table.build(&positions, &[700, 1730], 2.6, &Periodic::NONE);
        for row in 0..positions.len() {
            let (block, lane) = table.place(row);
            assert_eq!(table.rows[block][lane] as usize, row);
            let body = if row < 700 { 0..700 } else { 700..1730 };
            let start = row - (row - body.start) % BLOCK;
            assert!(table.of_rows(&(start..(start + BLOCK).min(body.end))).contains(&block));
            assert!(table.of_rows(&body).contains(&block));
            assert!(table.of_rows(&(row..row + 1)).contains(&block));
        }
        let longest = |half: &DVec3| 2.0 * half.max_element();
        assert!(table.halves.iter().all(|half| longest(half) <= 2.0 * 2.6 + 1e-6));
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
