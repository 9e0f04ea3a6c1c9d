//! Bound of the relative displacement of neighbouring particles since the lists were built.
//!
//! A list is valid as long as no pair beyond its skin has come within the support. Only relative
//! displacements of neighbours count, so that a uniform motion, as of a jet, does not use up the skin. Space
//! is divided into cells; the displacements of the particles of a cell lie in a box, and the boxes of a cell
//! and of its adjacent cells contain those of all neighbours. Particles of cells that are not adjacent were
//! at least the length of a cell apart.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::displacement_bounds::{BoundsBuilder, DisplacementBounds};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::neighbors::{Buckets, CellBlock, Periodic, SHIFT, sort_into_cells};
use crate::parallel::{FourLanes, HotLoop, Lanes4, run_hot};
use crate::ranks;

/// Conditions for the validity of lists, m.
#[derive(Clone, Copy, Debug)]
pub struct Skins {
    /// Support radius.
    pub support: f64,
    /// Skin of the lists of fluids among themselves.
    pub fluid: f64,
    /// Skin of the lists of fluids and boundary particles.
    pub walls: f64,
    /// Skin of the lists of boundaries among themselves; without end where there are none.
    pub gaps: f64,
}

/// Skin of the neighbour lists of fluids over their spacing.
const SKIN: f64 = 0.4;
/// The same of fluids and boundary particles: fluids slide along walls, and few particles are near one.
const WALL_SKIN: f64 = 0.8;

impl Skins {
    /// The usual ones of a spacing, m; less where a periodic domain is so short that a list would hold two
    /// images of a particle.
    pub fn new(support: f64, spacing: f64, periodic: &Periodic) -> Self {
        let lengths = periodic.lengths().to_array().into_iter().filter(|&length| length > 0.0);
        let widest = lengths
            .fold(f64::INFINITY, |widest, length| widest.min((0.5 - 1e-9) * length - support))
            .max(0.0);
        Self {
            support,
            fluid: widest.min(SKIN * spacing),
            walls: widest.min(WALL_SKIN * spacing),
            gaps: f64::INFINITY,
        }
    }
}

/// Displacements in a cell: of fluids, and of boundary particles.
type Pair = [DisplacementBounds; 2];

/// Where particles are, and where they were when the lists were built, m.
#[derive(Clone, Copy)]
pub struct Places<'a> {
    pub records: &'a [FlowParticle],
    pub then: &'a [DVec3],
}

/// The cells, with the particles that were in each when the lists were built.
#[derive(Debug, Default)]
pub struct Drift {
    grid: CellBlock,
    /// Periods of the axes along which the grid repeats, m, and one over them; zero on the others.
    periods: [Lanes4; 2],
    /// Minimum length of a cell, m.
    length: f64,
    /// The particles of each cell, ascending.
    cells: Buckets,
    spreads: Vec<Pair>,
    window: Vec<Pair>,
}

impl Drift {
    /// Sorts particles into cells of at least that length, m.
    pub fn sort(&mut self, positions: &[DVec3], length: f64, periodic: &Periodic) {
        let period = periodic.lengths();
        let inverse = DVec3::from_array(period.to_array().map(|l| if l > 0.0 { 1.0 / l } else { 0.0 }));
        self.periods = [Lanes4::new(period, 0.0), Lanes4::new(inverse, 0.0)];
        let sorted = sort_into_cells(&mut self.cells, positions, length, periodic);
        self.grid = CellBlock { counts: sorted.counts, wraps: periodic.axes() };
        self.length = sorted.length;
    }

    /// How much particles near each other can at least still move against each other until a list that was
    /// built where they were sorted misses a pair, m; below zero where one may miss one already, or none was
    /// built. The first `fluid` particles are those of the fluid; `own` are the rows that this rank looks at.
    pub fn remaining_skin(
        &mut self,
        places: Places<'_>,
        own: &[Range<usize>],
        fluid: usize,
        skins: Skins,
    ) -> f64 {
        if places.then.len() != places.records.len() {
            return f64::NEG_INFINITY;
        }
        let Self { cells, spreads, periods, .. } = self;
        spreads.resize(cells.count(), [DisplacementBounds::NONE; 2]);
        spreads.par_iter_mut().with_min_len(64).enumerate().for_each(|(cell, spread)| {
            let rows = &cells.rows[cells.range(cell)];
            let before = |row: usize| rows.partition_point(|&other| (other as usize) < row);
            let part = |own: &Range<usize>| {
                run_hot(Moved { places, rows: &rows[before(own.start)..before(own.end)], periods })
            };
            *spread = [DisplacementBounds::NONE; 2];
            for own in own {
                let of_kind = &mut spread[usize::from(own.start >= fluid)];
                *of_kind = of_kind.with(part(own));
            }
        });
        let join = |[a, b]: Pair, [c, d]: Pair| [a.with(c), b.with(d)];
        ranks::join(spreads, join);
        let all = spreads
            .iter()
            .fold(DisplacementBounds::NONE, |all, [fluid, walls]| all.with(*fluid).with(*walls));
        let far_apart = self.length - skins.support - all.farthest(all);
        if far_apart < 0.0 {
            return far_apart;
        }
        self.grid.join_beside(&mut self.spreads, &mut self.window, &join);
        let least = |[fluid, walls]: &Pair| {
            let flow = (skins.fluid - fluid.farthest(*fluid)).min(skins.walls - fluid.farthest(*walls));
            flow.min(skins.gaps - walls.farthest(*walls))
        };
        let near = self.spreads.par_iter().with_min_len(256).map(least).reduce(|| f64::INFINITY, f64::min);
        far_apart.min(near)
    }

    /// Lists the particles from row `first` on, ascending, that have one with another label in their cell or
    /// in one beside it. A label of `u32::MAX` counts for nothing.
    pub fn rows_beside_others(&self, first: usize, label: impl Fn(usize) -> u32, out: &mut Vec<usize>) {
        const NONE: [u32; 2] = [u32::MAX, 0];
        let labels = |cell: usize| {
            let rows = &self.cells.rows[self.cells.range(cell)];
            let rows = &rows[rows.partition_point(|&row| (row as usize) < first)..];
            rows.iter()
                .map(|&row| (row as usize, label(row as usize)))
                .filter(|(_, label)| *label != u32::MAX)
        };
        let join = |a: [u32; 2], b: [u32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let of_cell = |cell| labels(cell).fold(NONE, |all, (_, label)| join(all, [label, label]));
        let mut ranges: Vec<[u32; 2]> = (0..self.cells.count()).map(of_cell).collect();
        self.grid.join_beside(&mut ranges, &mut Vec::new(), &join);
        out.clear();
        for (cell, [low, high]) in ranges.into_iter().enumerate().filter(|(_, [low, high])| low < high) {
            out.extend(labels(cell).filter(|(_, label)| low < *label || *label < high).map(|(row, _)| row));
        }
        out.sort_unstable();
    }
}

/// Displacements of some particles.
struct Moved<'a> {
    places: Places<'a>,
    rows: &'a [u32],
    periods: &'a [Lanes4; 2],
}

impl HotLoop for Moved<'_> {
    type Output = DisplacementBounds;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> DisplacementBounds {
        let Places { records, then } = self.places;
        let [period, inverse] = *self.periods;
        let shift = Lanes4::splat(SHIFT);
        let mut moved = BoundsBuilder::new();
        for &row in self.rows {
            let row = row as usize;
            let x = a.sub(records[row].place, Lanes4::new(then[row], 0.0));
            // To the nearest periodic image.
            let turns = a.sub(a.mul_add(x, inverse, shift), shift);
            moved.add(a, a.sub(x, a.mul(period, turns)));
        }
        moved.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKINS: Skins = Skins { support: 0.26, fluid: 0.04, walls: 0.08, gaps: f64::INFINITY };

    /// Particles that hop about, and those of a floor.
    fn places(fluid: usize, floor: usize) -> Vec<DVec3> {
        let place = |k: usize| {
            let t = k as f64;
            DVec3::new((0.37 * t).sin(), 1.2 + (1.7 * t + 0.3).sin(), 0.3 * (0.9 * t + 1.1).sin())
        };
        let tile = |k: usize| DVec3::new(-1.0 + 0.1 * (k % 20) as f64, 0.0, -0.3 + 0.1 * (k / 20) as f64);
        (0..fluid).map(place).chain((0..floor).map(tile)).collect()
    }

    fn records(positions: &[DVec3]) -> Vec<FlowParticle> {
        positions
            .iter()
            .map(|&x| FlowParticle { place: Lanes4::new(x, 1e-3), ..FlowParticle::default() })
            .collect()
    }

    /// Whether a pair that the lists do not hold is within the support.
    fn misses(then: &[DVec3], now: &[DVec3], fluid: usize, periodic: &Periodic) -> bool {
        (0..fluid).any(|i| {
            (i + 1..then.len()).any(|j| {
                let skin = if j < fluid { SKINS.fluid } else { SKINS.walls };
                let distance = |x: &[DVec3]| periodic.minimal_image(x[j] - x[i]).length();
                distance(then) > SKINS.support + skin && distance(now) < SKINS.support
            })
        })
    }

    #[test]
    fn no_pair_is_missed() {
        let box_ = Periodic::new(DVec3::splat(-1.1), DVec3::splat(2.3), [true, false, false]);
        for periodic in [Periodic::NONE, box_.expect("a box")] {
            let then = places(700, 120);
            let mut drift = Drift::default();
            drift.sort(&then, 2.0 * SKINS.support, &periodic);
            let (mut small, mut missed) = (0, 0);
            for n in 1..200 {
                let t = 0.002 * f64::from(n);
                // A flow that shears and carries everything along.
                let flow = |x: DVec3| DVec3::new(1.0 + 0.2 * x.y, 0.3 * (2.0 * x.x).sin() - 0.5, 0.0);
                let now: Vec<DVec3> = then
                    .iter()
                    .enumerate()
                    .map(|(k, x)| if k < 700 { *x + t * flow(*x) } else { *x })
                    .collect();
                let places = Places { records: &records(&now), then: &then };
                let is_small =
                    drift.remaining_skin(places, std::slice::from_ref(&(0..820)), 700, SKINS) >= 0.0;
                let misses = misses(&then, &now, 700, &periodic);
                assert!(!(is_small && misses), "{n}");
                small += i32::from(is_small);
                missed += i32::from(misses);
            }
            assert!(small > 10 && missed > 50, "{small} {missed}");
        }
    }

    #[test]
    fn what_flies_as_a_whole_has_not_drifted() {
        let then = places(700, 0);
        let mut drift = Drift::default();
        drift.sort(&then, 2.0 * SKINS.support, &Periodic::NONE);
        let moved = |by: DVec3| -> Vec<DVec3> { then.iter().map(|x| *x + by).collect() };
        let all = std::slice::from_ref(&(0..700));
        let now = records(&moved(DVec3::new(70.0, -3.0, 0.1)));
        let left = drift.remaining_skin(Places { records: &now, then: &then }, all, 700, SKINS);
        assert!((left - SKINS.fluid).abs() < 1e-12, "{left}");
        for wrong in [f64::NAN, f64::INFINITY] {
            let mut now = moved(DVec3::ZERO);
            now[5].x = wrong;
            let places = Places { records: &records(&now), then: &then };
            assert!(drift.remaining_skin(places, all, 700, SKINS) < 0.0);
        }
    }
}
