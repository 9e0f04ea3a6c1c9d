//! Loops over a row in two parts: one gathers neighbours, one takes roots and kernel weights.
//!
//! In one loop, a neighbour takes some ninety cycles from its index to its sum, and a processor looks ahead
//! two or three fours. Taken apart, each loop has short chains of instructions that wait for each other, and
//! both run at the rate at which instructions are issued.

use crate::parallel::Lanes4;

/// Fours of a batch; two to some power.
pub const BATCH: usize = 32;

/// Two numbers for each pair of a batch.
pub struct Batch {
    /// Squares of the lengths, m2.
    square: [Lanes4; BATCH],
    /// Factors of the kernel weight.
    factor: [Lanes4; BATCH],
}

impl Batch {
    /// An empty one. Make it once for many rows.
    pub const EMPTY: Self = Self { square: [Lanes4::ZERO; BATCH], factor: [Lanes4::ZERO; BATCH] };

    /// Writes the four `k`, counted from the first of any batch.
    #[inline(always)]
    pub fn put(&mut self, k: usize, square: Lanes4, factor: Lanes4) {
        self.square[k % BATCH] = square;
        self.factor[k % BATCH] = factor;
    }

    /// Square and factor of the four `k`.
    #[inline(always)]
    pub fn get(&self, k: usize) -> (Lanes4, Lanes4) {
        (self.square[k % BATCH], self.factor[k % BATCH])
    }
}
