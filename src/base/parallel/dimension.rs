//! Hot loops in two- and three-dimensional versions; in plane strain the third axis is omitted from the sums.

use super::arithmetic::FourLanes;
use super::path::{HotLoop, run_hot};

/// A loop that is compiled for two and for three axes, each for every instruction path.
pub trait PlaneOrSpace {
    /// The loop over `D` axes; mark it `#[inline(always)]`.
    fn run<A: FourLanes, const D: usize>(self, arithmetic: A);
}

struct Axes<L, const D: usize>(L);

impl<L: PlaneOrSpace, const D: usize> HotLoop for Axes<L, D> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, arithmetic: A) {
        self.0.run::<A, D>(arithmetic);
    }
}

/// Runs the two- or three-dimensional version on the best instruction path of this processor.
#[inline]
pub fn run_hot_in<L: PlaneOrSpace>(plane: bool, hot: L) {
    if plane { run_hot(Axes::<L, 2>(hot)) } else { run_hot(Axes::<L, 3>(hot)) }
}
