//! The minimum of lengths.

use crate::parallel::BlockSum;

/// The least of lengths, m; infinite where there is none.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Least(pub f64);

impl Default for Least {
    fn default() -> Self {
        Self(f64::INFINITY)
    }
}

impl BlockSum for Least {
    fn add(&mut self, next: &Self) {
        self.0 = self.0.min(next.0);
    }
}
