//! Vectors of four lanes hold three components and one more number, so that a row is one aligned load.
//! Vectors of eight lanes of single precision hold one number for each particle of a block.
//!
//! Hot loops use the operations of [`Arithmetic`](super::Arithmetic) on them. The lanes are written out,
//! because a closure would not be compiled for the instruction path of its loop.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

/// Four numbers in one vector register.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(32))]
pub struct Lanes4(pub [f64; 4]);

impl Default for Lanes4 {
    /// Zero. A derived implementation would call that of arrays, which is not inlined in hot loops.
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

impl Lanes4 {
    /// Zero in all lanes.
    pub const ZERO: Self = Self([0.0; 4]);

    /// A vector, and a number in the last lane.
    #[inline(always)]
    pub fn new(v: DVec3, last: f64) -> Self {
        Self([v.x, v.y, v.z, last])
    }

    /// The same number in all lanes.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; 4])
    }

    /// Sum of the lanes, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        (self.0[0] + self.0[1]) + (self.0[2] + self.0[3])
    }

    /// The first three lanes.
    #[inline(always)]
    pub fn xyz(self) -> DVec3 {
        DVec3::new(self.0[0], self.0[1], self.0[2])
    }

    /// Scalar product of the first three lanes.
    #[inline(always)]
    pub fn dot3(self, o: Self) -> f64 {
        self.0[0] * o.0[0] + self.0[1] * o.0[1] + self.0[2] * o.0[2]
    }
}

/// Number of lanes of a block.
pub const EIGHT: usize = 8;

/// Eight numbers in one vector register.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(32))]
pub struct Lanes8(pub [f32; EIGHT]);

impl Lanes8 {
    /// Zero in all lanes.
    pub const ZERO: Self = Self([0.0; EIGHT]);

    /// Sum of the lanes, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        f64::from(((a + b) + (c + d)) + ((e + f) + (g + h)))
    }
}

impl Default for Lanes8 {
    /// Zero. A derived implementation would call that of arrays, which is not inlined in hot loops.
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}
