//! Vectors of rotation, lane by lane; in the plane they stand across it.

use std::ops::Sub;

use glam::DVec3;

use crate::parallel::{Arithmetic, Number, Vector};

/// An axial vector for each lane: in the plane its x and y are zero, and cost nothing.
#[derive(Clone, Copy)]
pub struct Axial<A: Arithmetic> {
    x: Number<A>,
    y: Number<A>,
    z: Number<A>,
}

impl<A: Arithmetic> Axial<A> {
    /// Zero in all lanes.
    #[inline(always)]
    pub fn zero(a: A) -> Self {
        Self { x: Number::zero(a), y: Number::zero(a), z: Number::zero(a) }
    }

    /// Those of vectors that [`pack_axial`] has made.
    #[inline(always)]
    pub fn of(Vector { x, y, z }: Vector<A>) -> Self {
        if A::AXES == 3 { Self { x, y, z } } else { Self { z: x, ..Self::zero(x.arithmetic()) } }
    }

    /// The vectors of these, as passes over rows sum them.
    #[inline(always)]
    pub fn into_row(self) -> Vector<A> {
        if A::AXES == 3 { self.into_vector() } else { Vector { x: self.z, y: self.x, z: self.y } }
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
}

impl<A: Arithmetic> Sub for Axial<A> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let z = self.z - other.z;
        if A::AXES == 3 { Self { x: self.x - other.x, y: self.y - other.y, z } } else { Self { z, ..self } }
    }
}

/// An axial vector as a pass over rows reads it: vectors have no z in the plane.
#[inline(always)]
pub fn pack_axial(v: DVec3, plane: bool) -> DVec3 {
    if plane { DVec3::new(v.z, 0.0, 0.0) } else { v }
}

/// The axial vector that was packed, or summed from such.
#[inline(always)]
pub fn unpack_axial(v: DVec3, plane: bool) -> DVec3 {
    if plane { DVec3::new(0.0, 0.0, v.x) } else { v }
}
