//! Moments of the particles around one beside a gap: its own body and the fluid, and other bodies.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, part};
use crate::linalg::Sym3;

/// First moment of the empty space before a particle, over that before a plane surface, below which the space
/// is a gap and above which it is open: along the way to the other body, and across it. A gap as wide as the
/// spacing has .75 along that way; where a dry gap ends at a corner it is .7 across.
const ALONG: [f64; 2] = [0.75, 0.9];
const ACROSS: [f64; 2] = [0.3, 0.5];

/// A particle near one beside a gap.
#[derive(Clone, Copy, Debug)]
pub struct GapPair {
    /// Its row in the cloud.
    pub row: usize,
    /// x_ij, m.
    pub x: DVec3,
    /// `V_j W_ij`.
    pub value: f64,
    /// `V_j w_ij`, 1/m2.
    pub weight: f64,
}

/// Neighbourhood of a particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surrounding {
    /// First moment of its own body and the fluid, 1/m.
    own: DVec3,
    /// Second moment of the same.
    second: Sym3,
    /// Moments of other bodies.
    other: DVec3,
    other_second: Sym3,
}

impl FlowCloud {
    /// The pair of a particle and particle `j` of the cloud; none beyond the support.
    #[inline]
    pub(super) fn gap_pair(&self, i: usize, j: u32) -> Option<GapPair> {
        let record = &self.records[j as usize];
        let x = self.offset(self.records[i].position(), record.position());
        let (square, volume) = (x.length_squared(), record.volume());
        if square >= self.kernel.support * self.kernel.support || volume <= 0.0 {
            return None;
        }
        let r = square.sqrt();
        let (value, weight) = (volume * self.kernel.value(r), volume * self.kernel.weight(r));
        Some(GapPair { row: j as usize, x, value, weight })
    }

    /// The particles of other bodies within the support of a particle in the lists of gaps.
    pub(super) fn across_gap(&self, [row, k]: [u32; 2]) -> impl Iterator<Item = GapPair> {
        let gaps = &self.pairs.gaps;
        let (row, list) = (row as usize, gaps.list.row(k as usize));
        let own = &gaps.side_of(row).rows;
        // A row is ordered by bodies.
        let (before, rest) = list.split_at(list.partition_point(|&j| (j as usize) < own.start));
        let after = &rest[rest.partition_point(|&j| (j as usize) < own.end)..];
        before.iter().chain(after).filter_map(move |&j| self.gap_pair(row, j))
    }
}

impl Surrounding {
    /// Of a particle in the lists of gaps.
    pub fn of(cloud: &FlowCloud, [row, k]: [u32; 2]) -> Self {
        let mut sum = Self::default();
        let list = cloud.pairs.gaps.list.row(k as usize);
        let own = part(list, &cloud.pairs.gaps.side_of(row as usize).rows);
        for &j in own.iter().chain(cloud.near_row(row as usize)) {
            let Some(GapPair { x, weight, .. }) = cloud.gap_pair(row as usize, j) else { continue };
            sum.own += weight * x;
            sum.second += weight * Sym3::dyad(x);
        }
        for GapPair { x, weight, .. } in cloud.across_gap([row, k]) {
            sum.other += weight * x;
            sum.other_second += weight * Sym3::dyad(x);
        }
        sum
    }

    /// Direction of the other bodies.
    pub fn toward(&self) -> DVec3 {
        self.other.normalize_or_zero()
    }

    /// Share of the empty space around the particle that is a gap, zero where it is open; `surface` is the
    /// first moment of a plane surface, 1/m.
    pub fn closed(&self, surface: f64) -> f64 {
        let empty = -(self.own + self.other) / surface;
        let toward = self.toward();
        let along = empty.dot(toward);
        let across = (empty - along * toward).length();
        let below = |x: f64, [low, high]: [f64; 2]| ((high - x) / (high - low)).clamp(0.0, 1.0);
        below(along, ALONG).min(below(across, ACROSS))
    }

    /// Force over the volume of the particle, N/m3, of a fluid that fills the empty space around it, with
    /// this pressure at the particle, Pa, and this gradient, Pa/m.
    pub fn force(&self, pressure: f64, slope: DVec3) -> DVec3 {
        let first = self.own + self.other;
        let second = Sym3::IDENTITY - self.second - self.other_second;
        2.0 * pressure * first - second * slope
    }
}

/// First moment of the empty half of the support before a plane surface of a lattice of that spacing, m, in
/// 1/m.
pub fn of_surface(cloud: &FlowCloud, spacing: f64) -> f64 {
    let layers = (cloud.kernel.support / spacing).ceil() as i32;
    let across = if cloud.plane { 0..=0 } else { -layers..=layers };
    let volume = spacing.powi(if cloud.plane { 2 } else { 3 });
    let mut sum = 0.0;
    for i in 1..=layers {
        for j in -layers..=layers {
            for k in across.clone() {
                let x = spacing * DVec3::new(f64::from(i), f64::from(j), f64::from(k));
                sum += volume * cloud.kernel.weight(x.length()) * x.x;
            }
        }
    }
    sum
}
