//! What a pass sums for each block.

use crate::parallel::{Lanes8, Split};

/// The sums of some blocks, `stride` vectors for each.
pub struct BlockSums<'a> {
    pub lanes: &'a mut [Lanes8],
    pub stride: usize,
}

impl Split for BlockSums<'_> {
    fn rows(&self) -> usize {
        self.lanes.len() / self.stride
    }

    fn split(self, at: usize) -> (Self, Self) {
        let stride = self.stride;
        let (lanes, rest) = self.lanes.split_at_mut(at * stride);
        (Self { lanes, stride }, Self { lanes: rest, stride })
    }
}
