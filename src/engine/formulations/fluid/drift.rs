//! How far particles have moved against those around them since the lists were built.
//!
//! A list is good as long as no pair beyond its skin has come within the support. That is a matter of how neighbours move against each
//! other: a jet that flies carries its list along. Space is cut into cells; what the particles of a cell have moved lies in a box, and the
//! boxes of a cell and those beside it hold all neighbours. Particles of cells that do not touch were the length of a cell apart.

use glam::DVec3;
use rayon::prelude::*;

use crate::neighbors::Periodic;

/// What has to hold for lists to be good, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Skins {
    /// Support radius.
    pub support: f64,
    /// Skin of the lists of fluids among themselves.
    pub fluid: f64,
    /// Skin of the lists of fluids and what bounds them.
    pub walls: f64,
}

/// Skin of the neighbour lists of fluids over their spacing.
const SKIN: f64 = 0.4;
/// The same of fluids and what bounds them: fluids slide along walls, and few particles are near one.
const WALL_SKIN: f64 = 0.8;

impl Skins {
    /// The usual ones of a spacing, m; less where a periodic domain is so short that a list would hold two images of a particle.
    pub fn new(support: f64, spacing: f64, periodic: &Periodic) -> Self {
        let lengths = periodic.lengths().to_array().into_iter().filter(|&length| length > 0.0);
        let room =
            lengths.fold(f64::INFINITY, |room, length| room.min((0.5 - 1e-9) * length - support)).max(0.0);
        Self { support, fluid: room.min(SKIN * spacing), walls: room.min(WALL_SKIN * spacing) }
    }
}

/// Displacements of some particles: the box around them; inverted where there are none.
#[derive(Clone, Copy, Debug)]
struct Spread {
    low: DVec3,
    high: DVec3,
}

impl Spread {
    const NONE: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Adds a displacement; one that is no number is as far as can be.
    #[inline(always)]
    fn add(self, d: DVec3) -> Self {
        if !d.is_finite() {
            return Self { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY };
        }
        Self { low: self.low.min(d), high: self.high.max(d) }
    }

    /// Most that a displacement of one box and one of the other differ, m; zero where one has none.
    fn farthest(self, other: Self) -> f64 {
        (self.high - other.low).max(other.high - self.low).max(DVec3::ZERO).length()
    }
}

/// Displacements in a cell: of fluids, and of what bounds them.
type Pair = [Spread; 2];

/// The cells, with the particles that were in each when the lists were built.
#[derive(Debug, Default)]
pub(super) struct Drift {
    counts: [usize; 3],
    /// Axes whose last cell is beside the first.
    wraps: [bool; 3],
    /// Least length of a cell, m.
    length: f64,
    /// Cell of each particle.
    cells: Vec<u32>,
    /// Particles of cell c are `order[starts[c]..starts[c + 1]]`, ascending.
    starts: Vec<u32>,
    order: Vec<u32>,
    spreads: Vec<Pair>,
    window: Vec<Pair>,
}

impl Drift {
    /// Sorts particles into cells of at least that length, m.
    pub fn sort(&mut self, positions: &[DVec3], length: f64, periodic: &Periodic) {
        let low = positions.iter().fold(DVec3::INFINITY, |a, x| a.min(*x));
        let high = positions.iter().fold(DVec3::NEG_INFINITY, |a, x| a.max(*x));
        self.wraps = periodic.axes();
        let lengths = DVec3::select(glam::BVec3::from_array(self.wraps), periodic.lengths(), high - low);
        let lengths = lengths.max(DVec3::ZERO);
        self.length = length;
        // Not more cells than particles: drops that fly far apart have larger ones.
        loop {
            let along = |a: usize| (lengths[a] / self.length).floor() as usize + usize::from(!self.wraps[a]);
            self.counts = [0, 1, 2].map(|a| along(a).max(1));
            let product = self.counts.iter().fold(1_usize, |product, &n| product.saturating_mul(n));
            if product <= positions.len() + 64 {
                break;
            }
            self.length *= 2.0;
        }
        let [nx, ny, nz] = self.counts;
        let wraps = self.wraps;
        let origin = DVec3::select(glam::BVec3::from_array(wraps), periodic.min(), low);
        let cell = DVec3::from_array(
            [0, 1, 2].map(|a| if wraps[a] { self.counts[a] as f64 / lengths[a] } else { 1.0 / self.length }),
        );
        let key = |x: DVec3| {
            let at = (periodic.wrap(x) - origin) * cell;
            let [i, j, k] = [(at.x, nx), (at.y, ny), (at.z, nz)].map(|(at, n)| (at as usize).min(n - 1));
            ((k * ny + j) * nx + i) as u32
        };
        self.cells.resize(positions.len(), 0);
        self.cells.par_iter_mut().with_min_len(4096).zip(positions).for_each(|(cell, x)| *cell = key(*x));
        self.starts.clear();
        self.starts.resize(nx * ny * nz + 2, 0);
        self.cells.iter().for_each(|&cell| self.starts[cell as usize + 2] += 1);
        for c in 2..self.starts.len() {
            self.starts[c] += self.starts[c - 1];
        }
        self.order.resize(positions.len(), 0);
        for (row, &cell) in self.cells.iter().enumerate() {
            let at = &mut self.starts[cell as usize + 1];
            self.order[*at as usize] = row as u32;
            *at += 1;
        }
        self.starts.pop();
    }

    /// Whether lists built at `then` miss no pair `now`; the first `fluid` particles are those of the fluid.
    pub fn is_small(
        &mut self,
        (then, now): (&[DVec3], &[DVec3]),
        fluid: usize,
        skins: Skins,
        periodic: &Periodic,
    ) -> bool {
        let Self { starts, order, spreads, .. } = self;
        spreads.resize(starts.len() - 1, [Spread::NONE; 2]);
        spreads.par_iter_mut().with_min_len(64).enumerate().for_each(|(cell, spread)| {
            *spread = [Spread::NONE; 2];
            for &row in &order[starts[cell] as usize..starts[cell + 1] as usize] {
                let row = row as usize;
                let moved = now[row] - then[row];
                let moved = if periodic.any() { periodic.minimal_image(moved) } else { moved };
                let of = &mut spread[usize::from(row >= fluid)];
                *of = of.add(moved);
            }
        });
        let all = spreads.iter().fold(Spread::NONE, |all, [fluid, walls]| all.with(*fluid).with(*walls));
        if all.farthest(all) > self.length - skins.support {
            return false;
        }
        (0..3).for_each(|axis| self.widen(axis));
        self.spreads.iter().all(|[fluid, walls]| {
            fluid.farthest(*fluid) <= skins.fluid && fluid.farthest(*walls) <= skins.walls
        })
    }

    /// Joins each cell with those beside it along an axis.
    fn widen(&mut self, axis: usize) {
        let Self { counts, wraps, spreads, window, .. } = self;
        let stride: usize = counts[..axis].iter().product();
        let count = counts[axis];
        if count == 1 {
            return;
        }
        window.clone_from(spreads);
        for (cell, spread) in spreads.iter_mut().enumerate() {
            let k = cell / stride % count;
            let first = cell - k * stride;
            let before = if k > 0 { Some(k - 1) } else { wraps[axis].then_some(count - 1) };
            let after = if k + 1 < count { Some(k + 1) } else { wraps[axis].then_some(0) };
            for beside in [before, after].into_iter().flatten() {
                let [fluid, walls] = window[first + beside * stride];
                *spread = [spread[0].with(fluid), spread[1].with(walls)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKINS: Skins = Skins { support: 0.26, fluid: 0.04, walls: 0.08 };

    /// Particles that hop about, and those of a floor.
    fn places(fluid: usize, floor: usize) -> Vec<DVec3> {
        let place = |k: usize| {
            let t = k as f64;
            DVec3::new((0.37 * t).sin(), 1.2 + (1.7 * t + 0.3).sin(), 0.3 * (0.9 * t + 1.1).sin())
        };
        let tile = |k: usize| DVec3::new(-1.0 + 0.1 * (k % 20) as f64, 0.0, -0.3 + 0.1 * (k / 20) as f64);
        (0..fluid).map(place).chain((0..floor).map(tile)).collect()
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
                let is_small = drift.is_small((&then, &now), 700, SKINS, &periodic);
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
        assert!(drift.is_small((&then, &moved(DVec3::new(70.0, -3.0, 0.1))), 700, SKINS, &Periodic::NONE));
        let mut now = moved(DVec3::ZERO);
        now[5].x = f64::NAN;
        assert!(!drift.is_small((&then, &now), 700, SKINS, &Periodic::NONE));
    }
}
