//! The arithmetic of a plane: the same instructions, and vectors without a third component.

use super::arithmetic::Arithmetic;
use super::lanes::Lanes4;
use super::path::{HotLoop, run_hot};

/// An instruction path whose vectors lie in the plane of x and y.
#[derive(Clone, Copy)]
struct Plane<A>(A);

macro_rules! pass_on {
    ($($function:ident($($argument:ident: $of:ty),+) -> $output:ty;)+) => {$(
        #[inline(always)]
        fn $function(self, $($argument: $of),+) -> $output {
            self.0.$function($($argument),+)
        }
    )+};
}

impl<A: Arithmetic> Arithmetic for Plane<A> {
    const AXES: usize = 2;

    pass_on! {
        mul_add(a: f64, b: f64, c: f64) -> f64;
        plus(a: Lanes4, b: Lanes4) -> Lanes4;
        minus(a: Lanes4, b: Lanes4) -> Lanes4;
        times(a: Lanes4, b: Lanes4) -> Lanes4;
        over(a: Lanes4, b: Lanes4) -> Lanes4;
        smaller(a: Lanes4, b: Lanes4) -> Lanes4;
        larger(a: Lanes4, b: Lanes4) -> Lanes4;
        where_below(a: Lanes4, b: Lanes4, c: Lanes4) -> Lanes4;
        below(a: Lanes4, b: Lanes4) -> usize;
        pack(values: [u32; 4], bits: usize) -> [u32; 4];
        times_add(a: Lanes4, b: Lanes4, c: Lanes4) -> Lanes4;
        sqrt(a: Lanes4) -> Lanes4;
        or_zero(a: Lanes4) -> Lanes4;
        transpose(rows: [Lanes4; 4]) -> [Lanes4; 4];
    }
}

struct InPlane<L>(L);

impl<L: HotLoop> HotLoop for InPlane<L> {
    type Output = L::Output;

    #[inline(always)]
    fn run<A: Arithmetic>(self, a: A) -> L::Output {
        self.0.run(Plane(a))
    }
}

/// Runs a hot loop on the best path of this processor, with vectors of the plane or of space.
pub fn run_hot_on<L: HotLoop>(plane: bool, hot: L) -> L::Output {
    if plane { run_hot(InPlane(hot)) } else { run_hot(hot) }
}
