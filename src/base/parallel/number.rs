//! SIMD numbers and vectors of several pairs, with operators, in which pair functions are written.
//!
//! A pair function is generic over [`Arithmetic`], and is compiled for every instruction path, in two and
//! three dimensions. It must be `#[inline(always)]`, because a call would leave the instruction path.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::arithmetic::Arithmetic;

/// One number per lane: four neighbours, or eight particles in single precision.
#[derive(Clone, Copy)]
pub struct Number<A: Arithmetic> {
    lanes: A::Lanes,
    arithmetic: A,
}

impl<A: Arithmetic> Number<A> {
    /// A vector of the given lanes.
    #[inline(always)]
    pub fn new(arithmetic: A, lanes: A::Lanes) -> Self {
        Self { lanes, arithmetic }
    }

    /// The same number in all lanes.
    #[inline(always)]
    pub fn splat(arithmetic: A, value: f64) -> Self {
        Self { lanes: arithmetic.splat(value), arithmetic }
    }

    /// Zero in all lanes.
    #[inline(always)]
    pub fn zero(arithmetic: A) -> Self {
        Self { lanes: arithmetic.splat(0.0), arithmetic }
    }

    /// The lanes.
    #[inline(always)]
    pub fn lanes(self) -> A::Lanes {
        self.lanes
    }

    /// The instruction path.
    #[inline(always)]
    pub fn arithmetic(self) -> A {
        self.arithmetic
    }

    /// Sum of all lanes, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.arithmetic.sum(self.lanes)
    }

    /// Square roots.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.with(self.arithmetic.sqrt(self.lanes))
    }

    /// Squares.
    #[inline(always)]
    pub fn squared(self) -> Self {
        self * self
    }

    /// The minimum of each number and `limit`.
    #[inline(always)]
    pub fn min(self, limit: f64) -> Self {
        self.with(self.arithmetic.min(self.lanes, self.arithmetic.splat(limit)))
    }

    /// The maximum of each number and `limit`.
    #[inline(always)]
    pub fn max(self, limit: f64) -> Self {
        self.with(self.arithmetic.max(self.lanes, self.arithmetic.splat(limit)))
    }

    /// `value` where the number is below `limit`, zero elsewhere; it replaces a branch.
    #[inline(always)]
    pub fn if_below(self, limit: f64, value: Self) -> Self {
        self.with(self.arithmetic.where_below(self.lanes, self.arithmetic.splat(limit), value.lanes))
    }

    /// `self b + c`, rounded once where the processor has a fused multiply-add.
    #[inline(always)]
    pub fn mul_add(self, b: Self, c: Self) -> Self {
        self.with(self.arithmetic.mul_add(self.lanes, b.lanes, c.lanes))
    }

    #[inline(always)]
    fn with(self, lanes: A::Lanes) -> Self {
        Self { lanes, arithmetic: self.arithmetic }
    }

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        self.with(self.arithmetic.splat(value))
    }
}

macro_rules! operators {
    ($($operator:ident $function:ident),+) => {$(
        impl<A: Arithmetic> $operator for Number<A> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.with(self.arithmetic.$function(self.lanes, other.lanes))
            }
        }

        impl<A: Arithmetic> $operator<f64> for Number<A> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                $operator::$function(self, self.like(other))
            }
        }

        impl<A: Arithmetic> $operator<Number<A>> for f64 {
            type Output = Number<A>;

            #[inline(always)]
            fn $function(self, other: Number<A>) -> Number<A> {
                $operator::$function(other.like(self), other)
            }
        }
    )+};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl<A: Arithmetic> Neg for Number<A> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        0.0 - self
    }
}

impl<A: Arithmetic> AddAssign for Number<A> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<A: Arithmetic> SubAssign for Number<A> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
