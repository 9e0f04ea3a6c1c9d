//! The extreme stretches of a body, on which its stable step depends.

use crate::linalg::smallest_and_largest_stretch;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::world::DeformationGradient;

/// Smallest and largest principal stretch; one where nothing is stretched.
#[derive(Clone, Copy)]
pub(super) struct Stretches {
    pub smallest: f64,
    pub largest: f64,
}

impl Default for Stretches {
    fn default() -> Self {
        Self { smallest: 1.0, largest: 1.0 }
    }
}

impl Stretches {
    /// The extreme stretches of the particles of a body.
    pub fn of(gradient: &[DeformationGradient]) -> Self {
        sum_over_blocks(gradient, &|_, rows: &[DeformationGradient]| {
            rows.iter().fold(Self::default(), |all, row| all.with(smallest_and_largest_stretch(row.0)))
        })
    }

    fn with(self, (smallest, largest): (f64, f64)) -> Self {
        Self { smallest: self.smallest.min(smallest), largest: self.largest.max(largest) }
    }
}

impl BlockSum for Stretches {
    fn add(&mut self, next: &Self) {
        *self = self.with((next.smallest, next.largest));
    }
}
