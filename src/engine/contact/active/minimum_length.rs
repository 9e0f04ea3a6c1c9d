//! The minimum of lengths, in parallel.

use crate::parallel::BlockSum;

/// The minimum of lengths, m; infinite where there is none.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct MinimumLength(pub f64);

impl Default for MinimumLength {
    fn default() -> Self {
        Self(f64::INFINITY)
    }
}

impl MinimumLength {
    /// Takes in a length, m.
    #[inline]
    pub fn add_length(&mut self, length: f64) {
        self.0 = self.0.min(length);
    }
}

impl BlockSum for MinimumLength {
    fn add(&mut self, next: &Self) {
        self.add_length(next.0);
    }
}
