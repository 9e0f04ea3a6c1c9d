//! Two-dimensional arithmetic: the same instructions on vectors without a third component.

use super::arithmetic::{Arithmetic, EightLanes, FourLanes};
use super::lanes::{EIGHT, Lanes4, Lanes8};
use super::path::{HotLoop, run_hot};

/// An instruction path with vectors in the x-y plane.
#[derive(Clone, Copy)]
pub struct Plane<A>(A);

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

    type Lanes = A::Lanes;

    pass_on! {
        splat(value: f64) -> A::Lanes;
        sum(a: A::Lanes) -> f64;
        add(a: A::Lanes, b: A::Lanes) -> A::Lanes;
        sub(a: A::Lanes, b: A::Lanes) -> A::Lanes;
        mul(a: A::Lanes, b: A::Lanes) -> A::Lanes;
        div(a: A::Lanes, b: A::Lanes) -> A::Lanes;
        min(a: A::Lanes, b: A::Lanes) -> A::Lanes;
        max(a: A::Lanes, b: A::Lanes) -> A::Lanes;
        where_below(a: A::Lanes, b: A::Lanes, c: A::Lanes) -> A::Lanes;
        below(a: A::Lanes, b: A::Lanes) -> usize;
        mul_add(a: A::Lanes, b: A::Lanes, c: A::Lanes) -> A::Lanes;
        sqrt(a: A::Lanes) -> A::Lanes;
        max_zero(a: A::Lanes) -> A::Lanes;
    }
}

impl<A: FourLanes> FourLanes for Plane<A> {
    type Eight = Plane<A::Eight>;

    #[inline(always)]
    fn eight(self) -> Self::Eight {
        Plane(self.0.eight())
    }

    #[inline(always)]
    fn prefetch<T>(self, rows: &[T], row: usize) {
        self.0.prefetch(rows, row);
    }

    pass_on! {
        scalar_mul_add(a: f64, b: f64, c: f64) -> f64;
        pack(values: [u32; 4], bits: usize) -> [u32; 4];
        transpose(rows: [Lanes4; 4]) -> [Lanes4; 4];
    }
}

impl<A: EightLanes> EightLanes for Plane<A> {
    pass_on! {
        same(value: f32) -> Lanes8;
        apart(j: i32, i: [i32; EIGHT]) -> Lanes8;
    }
}

pub(super) struct InPlane<L>(pub L);

impl<L: HotLoop> HotLoop for InPlane<L> {
    type Output = L::Output;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> L::Output {
        self.0.run(Plane(a))
    }
}

/// Runs a hot loop on the best path of this processor, with vectors of two or three components.
#[inline]
pub fn run_hot_on<L: HotLoop>(plane: bool, hot: L) -> L::Output {
    if plane { run_hot(InPlane(hot)) } else { run_hot(hot) }
}
