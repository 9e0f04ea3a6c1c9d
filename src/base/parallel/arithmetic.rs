//! The arithmetic of an instruction path: numbers, and vectors of four lanes.
//!
//! A loop that is written with [`Lanes4`] and these operations keeps its vectors in registers of four lanes.
//! Automatic vectorisation splits rows of four and recombines them in pairs, with twice the instructions.

use super::lanes::{EIGHT, Lanes4, Lanes8};

/// Operations on SIMD lanes, in which pair functions are written. A hot loop receives the arithmetic of the
/// instruction path for which it is compiled.
pub trait Arithmetic: Copy + Send + Sync {
    /// Number of components of vectors; further components are zero and cost no instruction.
    const AXES: usize = 3;

    /// One number per lane.
    type Lanes: Copy + Send + Sync;

    /// The same number in all lanes.
    fn splat(self, value: f64) -> Self::Lanes;

    /// Sum of the lanes, in a fixed order.
    fn sum(self, a: Self::Lanes) -> f64;

    /// `a + b`, lane by lane.
    fn add(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// `a - b`, lane by lane.
    fn sub(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// `a b`, lane by lane.
    fn mul(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// `a / b`, lane by lane.
    fn div(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// The minimum, lane by lane; `b` where one operand is NaN.
    fn min(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// The maximum, lane by lane; `b` where one operand is NaN.
    fn max(self, a: Self::Lanes, b: Self::Lanes) -> Self::Lanes;

    /// `c` in lanes where `a < b`, zero in the others.
    fn where_below(self, a: Self::Lanes, b: Self::Lanes, c: Self::Lanes) -> Self::Lanes;

    /// Bit k is set where `a < b` in lane k.
    fn below(self, a: Self::Lanes, b: Self::Lanes) -> usize;

    /// `a b + c`, lane by lane.
    fn mul_add(self, a: Self::Lanes, b: Self::Lanes, c: Self::Lanes) -> Self::Lanes;

    /// Square root, lane by lane.
    fn sqrt(self, a: Self::Lanes) -> Self::Lanes;

    /// `max(a, 0)`, lane by lane; zero where `a` is NaN.
    fn max_zero(self, a: Self::Lanes) -> Self::Lanes;

    /// `s a`.
    #[inline(always)]
    fn scale(self, s: f64, a: Self::Lanes) -> Self::Lanes {
        self.mul(a, self.splat(s))
    }

    /// `s a + c`.
    #[inline(always)]
    fn scale_add(self, s: f64, a: Self::Lanes, c: Self::Lanes) -> Self::Lanes {
        self.mul_add(a, self.splat(s), c)
    }
}

/// The arithmetic of blocks: eight lanes of single precision.
pub trait EightLanes: Arithmetic<Lanes = Lanes8> {
    /// The same number in all lanes.
    fn same(self, value: f32) -> Lanes8;

    /// `j - i` with wrap-around at the ends of the integer range.
    fn apart(self, j: i32, i: [i32; EIGHT]) -> Lanes8;
}

/// The arithmetic of four lanes of double precision, in which hot loops over rows are written; a lane is a
/// neighbour or a component.
pub trait FourLanes: Arithmetic<Lanes = Lanes4> {
    /// The same path with eight lanes of single precision.
    type Eight: EightLanes;

    /// See [`FourLanes::Eight`].
    fn eight(self) -> Self::Eight;

    /// `a b + c`.
    fn scalar_mul_add(self, a: f64, b: f64, c: f64) -> f64;

    /// Prefetches a row into the cache before it is read or written; a row beyond the end has no effect.
    fn prefetch<T>(self, rows: &[T], row: usize);

    /// The values whose bits are set, packed in their order; the remaining lanes are undefined.
    fn pack(self, values: [u32; 4], bits: usize) -> [u32; 4];

    /// The transpose: four records of four numbers become four lanes of each number.
    fn transpose(self, rows: [Lanes4; 4]) -> [Lanes4; 4];

    /// The sum over the lanes of each vector, in the order of [`Lanes4::sum`].
    #[inline(always)]
    fn sums(self, of: [Lanes4; 4]) -> Lanes4 {
        let [a, b, c, d] = self.transpose(of);
        self.add(self.add(a, b), self.add(c, d))
    }
}

/// The baseline instruction set of the architecture.
#[derive(Clone, Copy)]
pub(super) struct Portable;
