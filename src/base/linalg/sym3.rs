//! Symmetric 3 x 3 matrix stored as six components.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3};
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// Symmetric 3 x 3 matrix: stress, strain, moment and correction matrices, with three quarters of the memory
/// traffic of a `DMat3`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable, serde::Serialize, serde::Deserialize)]
#[repr(C)]
pub struct Sym3 {
    /// Component 11.
    pub xx: f64,
    /// Component 22.
    pub yy: f64,
    /// Component 33.
    pub zz: f64,
    /// Components 12 and 21.
    pub xy: f64,
    /// Components 13 and 31.
    pub xz: f64,
    /// Components 23 and 32.
    pub yz: f64,
}

impl Sym3 {
    /// All components zero.
    pub const ZERO: Self = Self { xx: 0.0, yy: 0.0, zz: 0.0, xy: 0.0, xz: 0.0, yz: 0.0 };
    /// Identity.
    pub const IDENTITY: Self = Self { xx: 1.0, yy: 1.0, zz: 1.0, ..Self::ZERO };

    /// Diagonal matrix.
    #[inline(always)]
    pub const fn from_diagonal(diagonal: DVec3) -> Self {
        Self { xx: diagonal.x, yy: diagonal.y, zz: diagonal.z, ..Self::ZERO }
    }

    /// `v (x) v`.
    #[inline(always)]
    pub fn dyad(v: DVec3) -> Self {
        Self { xx: v.x * v.x, yy: v.y * v.y, zz: v.z * v.z, xy: v.x * v.y, xz: v.x * v.z, yz: v.y * v.z }
    }

    /// Symmetric part of a matrix, `(A + A^T) / 2`.
    #[inline(always)]
    pub fn symmetric_part(a: DMat3) -> Self {
        Self {
            xx: a.x_axis.x,
            yy: a.y_axis.y,
            zz: a.z_axis.z,
            xy: 0.5 * (a.x_axis.y + a.y_axis.x),
            xz: 0.5 * (a.x_axis.z + a.z_axis.x),
            yz: 0.5 * (a.y_axis.z + a.z_axis.y),
        }
    }

    /// `A^T A`: with A = F, the right Cauchy-Green tensor.
    #[inline(always)]
    pub fn gram(a: DMat3) -> Self {
        let (x, y, z) = (a.x_axis, a.y_axis, a.z_axis);
        Self { xx: x.dot(x), yy: y.dot(y), zz: z.dot(z), xy: x.dot(y), xz: x.dot(z), yz: y.dot(z) }
    }

    /// The full matrix.
    #[inline(always)]
    pub const fn to_matrix(self) -> DMat3 {
        DMat3::from_cols_array(&[
            self.xx, self.xy, self.xz, self.xy, self.yy, self.yz, self.xz, self.yz, self.zz,
        ])
    }

    /// Sum of the diagonal.
    #[inline(always)]
    pub fn trace(&self) -> f64 {
        self.xx + self.yy + self.zz
    }

    /// Determinant.
    #[inline(always)]
    pub fn determinant(&self) -> f64 {
        self.xx * (self.yy * self.zz - self.yz * self.yz) - self.xy * (self.xy * self.zz - self.yz * self.xz)
            + self.xz * (self.xy * self.yz - self.yy * self.xz)
    }

    /// Inverse; infinite or NaN components where the determinant is zero.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        let (a, b, c) = (
            self.yy * self.zz - self.yz * self.yz,
            self.xz * self.yz - self.xy * self.zz,
            self.xy * self.yz - self.xz * self.yy,
        );
        let scale = 1.0 / (self.xx * a + self.xy * b + self.xz * c);
        Self {
            xx: a * scale,
            yy: (self.xx * self.zz - self.xz * self.xz) * scale,
            zz: (self.xx * self.yy - self.xy * self.xy) * scale,
            xy: b * scale,
            xz: c * scale,
            yz: (self.xy * self.xz - self.xx * self.yz) * scale,
        }
    }

    /// `A : B`, the sum of products of all nine components.
    #[inline(always)]
    pub fn double_dot(&self, other: &Self) -> f64 {
        self.xx * other.xx
            + self.yy * other.yy
            + self.zz * other.zz
            + 2.0 * (self.xy * other.xy + self.xz * other.xz + self.yz * other.yz)
    }

    /// `sqrt(A : A)`.
    #[inline(always)]
    pub fn norm(&self) -> f64 {
        self.double_dot(self).sqrt()
    }

    /// `A - tr(A)/3 I`.
    #[inline(always)]
    pub fn deviator(&self) -> Self {
        let mean = self.trace() / 3.0;
        Self { xx: self.xx - mean, yy: self.yy - mean, zz: self.zz - mean, ..*self }
    }
}

impl Add for Sym3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self {
            xx: self.xx + b.xx,
            yy: self.yy + b.yy,
            zz: self.zz + b.zz,
            xy: self.xy + b.xy,
            xz: self.xz + b.xz,
            yz: self.yz + b.yz,
        }
    }
}

impl AddAssign for Sym3 {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl Sub for Sym3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Neg for Sym3 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Mul<f64> for Sym3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        Self {
            xx: self.xx * s,
            yy: self.yy * s,
            zz: self.zz * s,
            xy: self.xy * s,
            xz: self.xz * s,
            yz: self.yz * s,
        }
    }
}

impl Mul<Sym3> for f64 {
    type Output = Sym3;
    #[inline(always)]
    fn mul(self, a: Sym3) -> Sym3 {
        a * self
    }
}

impl Mul<DVec3> for Sym3 {
    type Output = DVec3;
    #[inline(always)]
    fn mul(self, v: DVec3) -> DVec3 {
        DVec3::new(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }
}
