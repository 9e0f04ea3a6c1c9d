//! SIMD vectors and matrices of several pairs.

use std::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

use glam::DVec3;

use super::arithmetic::{Arithmetic, FourLanes};
use super::lanes::Lanes4;
use super::number::Number;

/// One vector per lane; in two dimensions its z is zero.
#[derive(Clone, Copy)]
pub struct Vector<A: Arithmetic> {
    /// Components along x.
    pub x: Number<A>,
    /// Components along y.
    pub y: Number<A>,
    /// Components along z.
    pub z: Number<A>,
}

impl<A: Arithmetic> Vector<A> {
    /// Vectors of the given components.
    #[inline(always)]
    pub fn new(a: A, [x, y, z]: [A::Lanes; 3]) -> Self {
        let z = if A::AXES == 3 { z } else { a.splat(0.0) };
        Self { x: Number::new(a, x), y: Number::new(a, y), z: Number::new(a, z) }
    }

    /// The same vector in all lanes.
    #[inline(always)]
    pub fn splat(a: A, value: DVec3) -> Self {
        Self::new(a, [a.splat(value.x), a.splat(value.y), a.splat(value.z)])
    }

    /// Zero in all lanes.
    #[inline(always)]
    pub fn zero(a: A) -> Self {
        Self::new(a, [a.splat(0.0); 3])
    }

    /// Scalar products.
    #[inline(always)]
    pub fn dot(self, other: Self) -> Number<A> {
        let plane = self.y.mul_add(other.y, self.x * other.x);
        if A::AXES == 3 { self.z.mul_add(other.z, plane) } else { plane }
    }

    /// Squared lengths.
    #[inline(always)]
    pub fn length_squared(self) -> Number<A> {
        self.dot(self)
    }

    /// Sum of the vectors of all lanes, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> DVec3 {
        DVec3::new(self.x.sum(), self.y.sum(), if A::AXES == 3 { self.z.sum() } else { 0.0 })
    }

    /// `s self + v`.
    #[inline(always)]
    pub fn mul_add(self, s: Number<A>, v: Self) -> Self {
        let z = if A::AXES == 3 { self.z.mul_add(s, v.z) } else { v.z };
        Self { x: self.x.mul_add(s, v.x), y: self.y.mul_add(s, v.y), z }
    }
}

impl<A: FourLanes> Vector<A> {
    /// Four vectors.
    #[inline(always)]
    pub fn from_rows(a: A, [j, k, l, m]: [DVec3; 4]) -> Self {
        Self::new(
            a,
            [Lanes4([j.x, k.x, l.x, m.x]), Lanes4([j.y, k.y, l.y, m.y]), Lanes4([j.z, k.z, l.z, m.z])],
        )
    }
}

impl<A: Arithmetic> Add for Vector<A> {
    type Output = Self;

    #[inline(always)]
    fn add(self, v: Self) -> Self {
        let z = if A::AXES == 3 { self.z + v.z } else { self.z };
        Self { x: self.x + v.x, y: self.y + v.y, z }
    }
}

impl<A: Arithmetic> Sub for Vector<A> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, v: Self) -> Self {
        let z = if A::AXES == 3 { self.z - v.z } else { self.z };
        Self { x: self.x - v.x, y: self.y - v.y, z }
    }
}

impl<A: Arithmetic> Mul<Number<A>> for Vector<A> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, s: Number<A>) -> Self {
        let z = if A::AXES == 3 { self.z * s } else { self.z };
        Self { x: self.x * s, y: self.y * s, z }
    }
}

impl<A: Arithmetic> Mul<f64> for Vector<A> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        self * Number::splat(self.x.arithmetic(), s)
    }
}

impl<A: Arithmetic> Div<Number<A>> for Vector<A> {
    type Output = Self;

    #[inline(always)]
    fn div(self, s: Number<A>) -> Self {
        self * (1.0 / s)
    }
}

impl<A: Arithmetic> AddAssign for Vector<A> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<A: Arithmetic> SubAssign for Vector<A> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// One matrix per lane, by its columns.
#[derive(Clone, Copy)]
pub struct Matrix<A: Arithmetic>(pub [Vector<A>; 3]);

impl<A: Arithmetic> Matrix<A> {
    /// `self v + w`.
    #[inline(always)]
    pub fn mul_add(self, v: Vector<A>, w: Vector<A>) -> Vector<A> {
        let Self([x, y, z]) = self;
        let plane = y.mul_add(v.y, x.mul_add(v.x, w));
        if A::AXES == 3 { z.mul_add(v.z, plane) } else { plane }
    }
}

impl<A: Arithmetic> Add for Matrix<A> {
    type Output = Self;

    #[inline(always)]
    fn add(self, Self(other): Self) -> Self {
        let Self(own) = self;
        Self([own[0] + other[0], own[1] + other[1], own[2] + other[2]])
    }
}

impl<A: Arithmetic> Mul<Vector<A>> for Matrix<A> {
    type Output = Vector<A>;

    #[inline(always)]
    fn mul(self, v: Vector<A>) -> Vector<A> {
        let Self([x, y, z]) = self;
        let plane = y.mul_add(v.y, x * v.x);
        if A::AXES == 3 { z.mul_add(v.z, plane) } else { plane }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::{HotLoop, run_hot_on};
    use glam::DMat3;

    struct Sample;

    fn rows(of: impl Fn(f64) -> DVec3) -> [DVec3; 4] {
        [of(0.3), of(-1.2), of(2.5), of(0.9)]
    }

    fn b(t: f64) -> DVec3 {
        DVec3::new(t, 1.0 - t * t, 2.0 * t)
    }

    fn c(t: f64) -> DVec3 {
        DVec3::new(t.sin(), 0.5, t.exp())
    }

    impl HotLoop for Sample {
        type Output = (DVec3, [f64; 4]);

        #[inline(always)]
        fn run<A: FourLanes>(self, a: A) -> Self::Output {
            let (b, c) = (Vector::from_rows(a, rows(b)), Vector::from_rows(a, rows(c)));
            let dot = b.dot(c);
            let matrix = Matrix([b, c, b + c]);
            let turned = matrix.mul_add(c - b * 2.0, b);
            let value = turned / (b.length_squared() + 0.5) * dot.min(1.0);
            (value.sum(), dot.if_below(0.4, (dot.max(-0.2) - 1.0) / 3.0).lanes().0)
        }
    }

    #[test]
    fn operators_are_those_of_single_numbers() {
        for plane in [false, true] {
            let flat = |v: DVec3| if plane { v.with_z(0.0) } else { v };
            let (sum, lanes) = run_hot_on(plane, Sample);
            let mut expected = DVec3::ZERO;
            for (k, t) in [0.3, -1.2, 2.5, 0.9].into_iter().enumerate() {
                let (b, c) = (flat(b(t)), flat(c(t)));
                let dot = b.dot(c);
                let matrix = DMat3::from_cols(b, c, b + c);
                expected += (matrix * (c - b * 2.0) + b) / (b.length_squared() + 0.5) * dot.min(1.0);
                let lane = if dot < 0.4 { (dot.max(-0.2) - 1.0) / 3.0 } else { 0.0 };
                assert!((lanes[k] - lane).abs() < 1e-15, "{lanes:?} {lane}");
            }
            assert!((sum - expected).length() < 1e-14 * expected.length(), "{sum} {expected}");
        }
    }
}
