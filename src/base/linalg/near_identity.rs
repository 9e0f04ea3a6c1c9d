//! Logarithm and exponential of symmetric matrices near the identity, such as elastic strains of metals.
//!
//! Closed forms with eigenvectors lose digits where eigenvalues nearly coincide, whereas series are most
//! accurate there. The spectral decomposition is used far from the identity.

use super::{Eigen, Sym3};

/// Maximum |A - I| (and |A| of the exponential) for which the series are used.
const NEAR: f64 = 0.1;

impl Sym3 {
    /// Product with a symmetric matrix of the same principal directions, which is symmetric.
    #[inline(always)]
    pub fn mul_coaxial(&self, b: &Self) -> Self {
        Self {
            xx: self.xx * b.xx + self.xy * b.xy + self.xz * b.xz,
            yy: self.xy * b.xy + self.yy * b.yy + self.yz * b.yz,
            zz: self.xz * b.xz + self.yz * b.yz + self.zz * b.zz,
            xy: self.xx * b.xy + self.xy * b.yy + self.xz * b.yz,
            xz: self.xx * b.xz + self.xy * b.yz + self.xz * b.zz,
            yz: self.xy * b.xz + self.yy * b.yz + self.yz * b.zz,
        }
    }

    /// `A + s I`.
    #[inline(always)]
    pub fn add_diagonal(&self, s: f64) -> Self {
        Self { xx: self.xx + s, yy: self.yy + s, zz: self.zz + s, ..*self }
    }

    /// Half of the logarithm of a positive definite matrix. For `b = V^2` it is the logarithmic strain `ln
    /// V`.
    ///
    /// Near the identity it is computed as artanh(Z) with Z = (A - I)(A + I)^-1, to 4e-12 of |Z|.
    #[inline(always)]
    pub fn half_log(&self) -> Self {
        let x = self.add_diagonal(-1.0);
        if x.double_dot(&x) <= NEAR * NEAR {
            let z = x.mul_coaxial(&self.add_diagonal(1.0).inverse());
            let y = z.mul_coaxial(&z);
            let inner = (y * (1.0 / 7.0)).add_diagonal(1.0 / 5.0);
            let outer = inner.mul_coaxial(&y).add_diagonal(1.0 / 3.0);
            z + outer.mul_coaxial(&y).mul_coaxial(&z)
        } else {
            half_log_by_eigenvalues(self)
        }
    }

    /// The matrix exponential, by its series to 2e-13 where the matrix is small.
    #[inline(always)]
    pub fn exp(&self) -> Self {
        if self.double_dot(self) <= NEAR * NEAR {
            let mut sum = (*self * (1.0 / 7.0)).add_diagonal(1.0);
            for k in [6.0, 5.0, 4.0, 3.0, 2.0, 1.0] {
                sum = (sum.mul_coaxial(self) * (1.0 / k)).add_diagonal(1.0);
            }
            sum
        } else {
            exp_by_eigenvalues(self)
        }
    }
}

#[cold]
#[inline(never)]
fn half_log_by_eigenvalues(a: &Sym3) -> Sym3 {
    Eigen::new(a).map(|value| 0.5 * value.ln())
}

#[cold]
#[inline(never)]
fn exp_by_eigenvalues(a: &Sym3) -> Sym3 {
    Eigen::new(a).map(f64::exp)
}
