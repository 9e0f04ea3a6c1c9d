//! The arithmetic of an instruction path: numbers, and vectors of four lanes.
//!
//! A loop that is written with [`Lanes4`] and these operations keeps its vectors in registers of four lanes.
//! Left to itself, the compiler takes rows of four apart and puts the pieces together in pairs: twice the
//! instructions.

use super::lanes::{EIGHT, Lanes4, Lanes8};

/// Operations on numbers of several lanes: what pair functions are written in. A hot loop gets the arithmetic
/// of the instruction path that it is compiled for.
pub trait Arithmetic: Copy + Send + Sync {
    /// Number of axes of vectors; the components of those beyond it are zero, and no instruction is spent on
    /// them.
    const AXES: usize = 3;

    /// A number for each lane.
    type Lanes: Copy + Send + Sync;

    /// The same number in all lanes.
    fn splat(self, value: f64) -> Self::Lanes;

    /// Sum of the lanes, in a fixed order.
    fn sum(self, a: Self::Lanes) -> f64;

    /// `a + b`, lane by lane.
    fn plus(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// `a - b`, lane by lane.
    fn minus(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// `a b`, lane by lane.
    fn times(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// `a / b`, lane by lane.
    fn over(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// The smaller one, lane by lane; `b` where one is not a number.
    fn smaller(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// The larger one, lane by lane; `b` where one is not a number.
    fn larger(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// `c` in lanes where `a < b`, zero in the others.
    fn where_below(self, a: Self::Lanes, b: Self::Lanes, c: Self::Lanes) -> Self::Lanes;

    /// Bit k is set where `a < b` in lane k.
    fn below(self, a: Self::Lanes, b: Self::Lanes) -> usize;

    /// `a b + c`, lane by lane.
    fn times_add(self, a: Self::Lanes, b: Self::Lanes, c: Self::Lanes) -> Self::Lanes;

    /// Square root, lane by lane.
    fn sqrt(self, a: Self::Lanes) -> Self::Lanes;

    /// `a`, or zero in lanes where it is not above zero.
    fn max_zero(self, a: Self::Lanes) -> Self::Lanes;

    /// `s a`.
    #[inline(always)]
    fn scale(self, s: f64, a: Self::Lanes) -> Self::Lanes {
        self.times(a, self.splat(s))
    }

    /// `s a + c`.
    #[inline(always)]
    fn scale_add(self, s: f64, a: Self::Lanes, c: Self::Lanes) -> Self::Lanes {
        self.times_add(a, self.splat(s), c)
    }
}

/// The arithmetic of blocks: eight lanes of single precision.
pub trait EightLanes: Arithmetic<Lanes = Lanes8> {
    /// The same number in all lanes.
    fn same(self, value: f32) -> Lanes8;

    /// `j - i` of numbers that go round at the ends of their range.
    fn apart(self, j: i32, i: [i32; EIGHT]) -> Lanes8;
}

/// The arithmetic of four lanes of double precision, in which a lane is a neighbour or a component: what hot
/// loops over rows are written in.
pub trait FourLanes: Arithmetic<Lanes = Lanes4> {
    /// The same path with eight lanes of single precision.
    type Eight: EightLanes;

    /// See [`FourLanes::Eight`].
    fn eight(self) -> Self::Eight;

    /// `a b + c`.
    fn mul_add(self, a: f64, b: f64, c: f64) -> f64;

    /// Asks the processor to bring a row into its cache, because it is going to be read or written; one
    /// beyond the end is asked for in vain.
    fn prefetch<T>(self, rows: &[T], row: usize);

    /// The values whose bits are set, in their order; what follows them has no meaning.
    fn pack(self, values: [u32; 4], bits: usize) -> [u32; 4];

    /// Rows and columns exchanged: four records of four numbers become four lanes of each number.
    fn transpose(self, rows: [Lanes4; 4]) -> [Lanes4; 4];

    /// The sum of the lanes of each, in the order of [`Lanes4::sum`].
    #[inline(always)]
    fn sums(self, of: [Lanes4; 4]) -> Lanes4 {
        let [a, b, c, d] = self.transpose(of);
        self.plus(self.plus(a, b), self.plus(c, d))
    }
}

/// The instructions that every processor of the architecture has.
#[derive(Clone, Copy)]
pub(super) struct Portable;
