//! Vectors of rotation of four neighbours at once; in the plane they stand across it.

use std::ops::Sub;

use glam::DVec3;

use crate::parallel::{FourLanes, Lanes4, Number, Vector};

/// An axial vector for each of four neighbours: in the plane its x and y are zero, and cost nothing.
#[derive(Clone, Copy)]
pub struct Axial<A: FourLanes> {
    x: Number<A>,
    y: Number<A>,
    z: Number<A>,
}

impl<A: FourLanes> Axial<A> {
    /// Zero four times.
    #[inline(always)]
    pub fn zero(a: A) -> Self {
        Self { x: Number::zero(a), y: Number::zero(a), z: Number::zero(a) }
    }

    /// The first three lanes of four rows.
    #[inline(always)]
    pub fn from_rows(a: A, [j, k, l, m]: [&Lanes4; 4]) -> Self {
        let along = |axis: usize| Number::new(a, Lanes4([j.0[axis], k.0[axis], l.0[axis], m.0[axis]]));
        if A::AXES == 3 {
            Self { x: along(0), y: along(1), z: along(2) }
        } else {
            Self { z: along(2), ..Self::zero(a) }
        }
    }

    /// The first three lanes of a row, four times.
    #[inline(always)]
    pub fn splat(a: A, row: &Lanes4) -> Self {
        Self::from_rows(a, [row; 4])
    }

    /// `x x (self x x)`: the angular momenta of points that turn with it.
    #[inline(always)]
    pub fn around(self, x: Vector<A>) -> Self {
        if A::AXES == 3 {
            Self::product(x, self.turn(x))
        } else {
            Self { z: self.z * x.length_squared(), ..self }
        }
    }

    /// Vector products of two vectors.
    #[inline(always)]
    pub fn product(u: Vector<A>, v: Vector<A>) -> Self {
        let z = u.x * v.y - u.y * v.x;
        if A::AXES == 3 {
            Self { x: u.y * v.z - u.z * v.y, y: u.z * v.x - u.x * v.z, z }
        } else {
            Self { z, ..Self::zero(z.arithmetic()) }
        }
    }

    /// Velocities of places that turn with it.
    #[inline(always)]
    pub fn turn(self, x: Vector<A>) -> Vector<A> {
        if A::AXES == 3 {
            Self::product(Vector { x: self.x, y: self.y, z: self.z }, x).into_vector()
        } else {
            Vector { x: -(self.z * x.y), y: self.z * x.x, z: x.z }
        }
    }

    #[inline(always)]
    fn into_vector(self) -> Vector<A> {
        Vector { x: self.x, y: self.y, z: self.z }
    }

    /// `s self + sum`.
    #[inline(always)]
    pub fn mul_add(self, s: Number<A>, sum: Self) -> Self {
        let z = self.z.mul_add(s, sum.z);
        if A::AXES == 3 {
            Self { x: self.x.mul_add(s, sum.x), y: self.y.mul_add(s, sum.y), z }
        } else {
            Self { z, ..sum }
        }
    }

    /// Sum of the four, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> DVec3 {
        if A::AXES == 3 {
            DVec3::new(self.x.sum(), self.y.sum(), self.z.sum())
        } else {
            DVec3::new(0.0, 0.0, self.z.sum())
        }
    }
}

impl<A: FourLanes> Sub for Axial<A> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let z = self.z - other.z;
        if A::AXES == 3 { Self { x: self.x - other.x, y: self.y - other.y, z } } else { Self { z, ..self } }
    }
}
