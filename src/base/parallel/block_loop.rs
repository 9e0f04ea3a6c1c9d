//! Loops over blocks of particles, in eight lanes of single precision.

use super::arithmetic::{EightLanes, FourLanes};
use super::path::HotLoop;
use super::plane::run_hot_on;

/// A loop over blocks that is compiled once for every instruction path, with the same requirements as
/// [`HotLoop`].
pub trait BlockLoop {
    /// Result of the loop.
    type Output;
    /// The loop; mark it `#[inline(always)]`.
    fn run<A: EightLanes>(self, arithmetic: A) -> Self::Output;
}

struct Wide<L>(L);

impl<L: BlockLoop> HotLoop for Wide<L> {
    type Output = L::Output;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> L::Output {
        self.0.run(a.eight())
    }
}

/// Runs a loop over blocks on the best path of this processor, with vectors of two or three components.
#[inline]
pub fn run_blocks_on<L: BlockLoop>(plane: bool, hot: L) -> L::Output {
    run_hot_on(plane, Wide(hot))
}
