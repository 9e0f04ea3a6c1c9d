//! Bound of the relative displacement of nearby particles since a neighbour list was built.
//!
//! A list with a skin is complete as long as no two particles have approached each other by more than the
//! skin. The criterion is the relative displacement of nearby particles, not their displacement: the list of
//! a body in free flight stays valid. Space is divided into cells. The displacements of the particles of a
//! cell have a bounding box, and the bounding box over a cell and its adjacent cells bounds the relative
//! displacement of the particles in them. Particles of cells that do not touch were at least the length of a
//! cell apart.

use glam::DVec3;
use rayon::prelude::*;

use super::{Buckets, CellBlock, Periodic, sort_into_cells};

/// Cells per task.
const CELLS_OF_TASK: usize = 64;

/// The cells, and the reference positions of their particles.
#[derive(Debug, Default)]
pub struct RelativeDisplacements {
    grid: CellBlock,
    length: f64,
    cells: Buckets,
    /// Reference positions in the order of cells, m.
    then: Vec<DVec3>,
    boxes: Vec<DisplacementBox>,
    window: Vec<DisplacementBox>,
}

/// Bounds of the relative displacement of particles, m.
#[derive(Clone, Copy, Debug)]
pub struct RelativeBounds {
    /// Maximum for particles that were nearer than the length of a cell.
    pub near: f64,
    /// Maximum for any two particles.
    pub all: f64,
}

/// Bounding box of displacements, m; inverted without displacements, infinite if one is NaN or infinite.
#[derive(Clone, Copy, Debug)]
struct DisplacementBox {
    low: DVec3,
    high: DVec3,
}

impl DisplacementBox {
    const NONE: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn and(self, d: DVec3) -> Self {
        if d.is_finite() {
            self.with(Self { low: d, high: d })
        } else {
            Self { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY }
        }
    }

    /// Maximum difference of two displacements, m.
    fn diagonal(self) -> f64 {
        (self.high - self.low).max(DVec3::ZERO).length()
    }
}

impl RelativeDisplacements {
    /// Stores the positions of the particles as the reference, in cells of at least the given length, m.
    pub fn note(&mut self, positions: &[DVec3], length: f64) {
        let sorted = sort_into_cells(&mut self.cells, positions, length, &Periodic::NONE);
        self.grid = CellBlock { counts: sorted.counts, wraps: [false; 3] };
        self.length = sorted.length;
        self.then.clear();
        self.then.extend(self.cells.rows.iter().map(|&row| positions[row as usize]));
    }

    /// Length of the cells, m.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Bound of the relative displacement of the particles since the last
    /// [`note`](RelativeDisplacements::note); infinite where the number of particles has changed.
    pub fn parted(&mut self, positions: &[DVec3]) -> RelativeBounds {
        if self.then.len() != positions.len() {
            return RelativeBounds { near: f64::INFINITY, all: f64::INFINITY };
        }
        let Self { cells, then, boxes, .. } = self;
        boxes.resize(cells.count(), DisplacementBox::NONE);
        boxes.par_iter_mut().with_min_len(CELLS_OF_TASK).enumerate().for_each(|(cell, own)| {
            let range = cells.range(cell);
            let places = cells.rows[range.clone()].iter().zip(&then[range]);
            let moved = places.map(|(&row, then)| positions[row as usize] - *then);
            *own = moved.fold(DisplacementBox::NONE, DisplacementBox::and);
        });
        let all = boxes.iter().fold(DisplacementBox::NONE, |all, own| all.with(*own)).diagonal();
        self.grid.join_beside(&mut self.boxes, &mut self.window, &DisplacementBox::with);
        let near = self.boxes.iter().map(|own| own.diagonal()).fold(0.0, f64::max);
        RelativeBounds { near, all }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places() -> Vec<DVec3> {
        let place = |k: usize| {
            let t = k as f64;
            DVec3::new((0.37 * t).sin(), (1.7 * t + 0.3).sin(), 0.3 * (0.9 * t + 1.1).sin())
        };
        (0..700).map(place).collect()
    }

    #[test]
    fn no_two_particles_have_moved_farther_than_it_says() {
        let then = places();
        let mut parting = RelativeDisplacements::default();
        parting.note(&then, 0.4);
        let mut is_tight = 0;
        for n in 1..40 {
            let t = 0.005 * f64::from(n);
            let now: Vec<DVec3> = then
                .iter()
                .map(|x| *x + DVec3::new(70.0 + t * x.y, t * (2.0 * x.x).sin(), t * t * x.z))
                .collect();
            let RelativeBounds { near, all } = parting.parted(&now);
            let (mut of_near, mut of_all) = (0.0_f64, 0.0_f64);
            for i in 0..then.len() {
                for j in 0..i {
                    let moved = ((now[i] - now[j]) - (then[i] - then[j])).length();
                    of_all = of_all.max(moved);
                    if (then[i] - then[j]).length() < parting.length() {
                        of_near = of_near.max(moved);
                    }
                }
            }
            assert!(of_near <= near + 1e-12 && of_all <= all + 1e-12, "{of_near} {near} {of_all} {all}");
            is_tight += i32::from(near < 0.8 * all);
        }
        assert!(is_tight > 30, "{is_tight}");
    }

    #[test]
    fn what_flies_as_a_whole_stays_together_and_what_is_no_number_does_not() {
        let then = places();
        let mut parting = RelativeDisplacements::default();
        assert!(parting.parted(&then).near == f64::INFINITY);
        parting.note(&then, 0.4);
        let mut now: Vec<DVec3> = then.iter().map(|x| *x + DVec3::new(70.0, -3.0, 0.1)).collect();
        assert!(parting.parted(&now).all < 1e-12);
        now[5].x = f64::NAN;
        assert!(parting.parted(&now).near == f64::INFINITY);
    }
}
