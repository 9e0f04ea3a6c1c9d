//! Vectors of four lanes: three components and one more number, so that a row is one aligned load.
//!
//! The lanes are written out: a closure would not be compiled for the instruction path of the loop it is used in.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::path::Arithmetic;

/// Four numbers in one vector register.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(32))]
pub struct Lanes4(pub [f64; 4]);

impl Lanes4 {
    /// A vector, and a number in the last lane.
    #[inline(always)]
    pub fn new(v: DVec3, last: f64) -> Self {
        Self([v.x, v.y, v.z, last])
    }

    /// The first three lanes.
    #[inline(always)]
    pub fn xyz(self) -> DVec3 {
        DVec3::new(self.0[0], self.0[1], self.0[2])
    }

    /// Sum.
    #[inline(always)]
    pub fn plus(self, o: Self) -> Self {
        Self([self.0[0] + o.0[0], self.0[1] + o.0[1], self.0[2] + o.0[2], self.0[3] + o.0[3]])
    }

    /// Difference.
    #[inline(always)]
    pub fn minus(self, o: Self) -> Self {
        Self([self.0[0] - o.0[0], self.0[1] - o.0[1], self.0[2] - o.0[2], self.0[3] - o.0[3]])
    }

    /// `s` times each lane.
    #[inline(always)]
    pub fn scale(self, s: f64) -> Self {
        Self([self.0[0] * s, self.0[1] * s, self.0[2] * s, self.0[3] * s])
    }

    /// `s` times each lane, plus `c`.
    #[inline(always)]
    pub fn scale_add<A: Arithmetic>(self, s: f64, c: Self) -> Self {
        Self([
            A::mul_add(self.0[0], s, c.0[0]),
            A::mul_add(self.0[1], s, c.0[1]),
            A::mul_add(self.0[2], s, c.0[2]),
            A::mul_add(self.0[3], s, c.0[3]),
        ])
    }

    /// Product lane by lane, plus `c`.
    #[inline(always)]
    pub fn multiply_add<A: Arithmetic>(self, o: Self, c: Self) -> Self {
        Self([
            A::mul_add(self.0[0], o.0[0], c.0[0]),
            A::mul_add(self.0[1], o.0[1], c.0[1]),
            A::mul_add(self.0[2], o.0[2], c.0[2]),
            A::mul_add(self.0[3], o.0[3], c.0[3]),
        ])
    }

    /// Sum of the products of the first three lanes.
    #[inline(always)]
    pub fn dot3(self, o: Self) -> f64 {
        self.0[0] * o.0[0] + self.0[1] * o.0[1] + self.0[2] * o.0[2]
    }
}
