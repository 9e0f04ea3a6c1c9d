//! Bounds of displacements: the box around them.

use bytemuck::{Pod, Zeroable};

use crate::parallel::{BlockSum, FourLanes, Lanes4};

/// Displacements of some particles, m: the box around them; inverted where there are none.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct DisplacementBounds {
    low: Lanes4,
    high: Lanes4,
}

impl Default for DisplacementBounds {
    #[inline(always)]
    fn default() -> Self {
        Self::NONE
    }
}

impl BlockSum for DisplacementBounds {
    fn add(&mut self, next: &Self) {
        *self = self.with(*next);
    }
}

impl DisplacementBounds {
    /// That of no displacement.
    pub const NONE: Self = Self { low: Lanes4([f64::INFINITY; 4]), high: Lanes4([f64::NEG_INFINITY; 4]) };
    /// As much as can be.
    const ALL: Self = Self { low: Self::NONE.high, high: Self::NONE.low };

    /// Whether nothing has moved, nor changed in the fourth lane.
    pub fn is_zero(self) -> bool {
        let is_zero = |Lanes4(lanes): Lanes4| lanes.iter().all(|lane| *lane == 0.0);
        is_zero(self.low) && is_zero(self.high)
    }

    /// The box around two boxes.
    #[inline(always)]
    pub fn with(self, other: Self) -> Self {
        Self { low: lane_min(self.low, other.low), high: lane_max(self.high, other.high) }
    }

    /// Maximum distance between a displacement of one box and one of the other, m; zero if one has none.
    pub fn farthest(self, other: Self) -> f64 {
        (self.high.xyz() - other.low.xyz())
            .max(other.high.xyz() - self.low.xyz())
            .max(glam::DVec3::ZERO)
            .length()
    }
}

/// The lanes are written out, as those of [`Lanes4`] are.
#[inline(always)]
fn lane_min(Lanes4(a): Lanes4, Lanes4(b): Lanes4) -> Lanes4 {
    let of = |k: usize| if a[k] < b[k] { a[k] } else { b[k] };
    Lanes4([of(0), of(1), of(2), of(3)])
}

#[inline(always)]
fn lane_max(Lanes4(a): Lanes4, Lanes4(b): Lanes4) -> Lanes4 {
    let of = |k: usize| if a[k] > b[k] { a[k] } else { b[k] };
    Lanes4([of(0), of(1), of(2), of(3)])
}

/// A spread that grows by one displacement after the other.
#[derive(Clone, Copy)]
pub struct BoundsBuilder {
    spread: DisplacementBounds,
    sum: Lanes4,
}

impl BoundsBuilder {
    #[inline(always)]
    pub fn new() -> Self {
        Self { spread: DisplacementBounds::NONE, sum: Lanes4::ZERO }
    }

    /// Adds a displacement; the fourth lane matters to [`DisplacementBounds::is_zero`] alone.
    #[inline(always)]
    pub fn add<A: FourLanes>(&mut self, a: A, d: Lanes4) {
        self.spread.low = a.min(d, self.spread.low);
        self.spread.high = a.max(d, self.spread.high);
        // What is no number does not show in the box.
        self.sum = a.add(self.sum, d);
    }

    /// The spread, as large as can be where a displacement was no number.
    #[inline(always)]
    pub fn end(self) -> DisplacementBounds {
        if self.sum.xyz().is_finite() { self.spread } else { DisplacementBounds::ALL }
    }
}
