//! Eigenvalues and eigenvectors of a symmetric matrix by cyclic Jacobi rotations.

use super::Sym3;
use glam::{DMat3, DVec3};

/// Spectral decomposition `A = sum_a values_a n_a (x) n_a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eigen {
    /// Eigenvalues, ascending.
    pub values: DVec3,
    /// Orthonormal eigenvectors n_a as columns, in the order of the values.
    pub vectors: DMat3,
}

impl Eigen {
    /// Decomposes a matrix: accurate to rounding relative to the largest eigenvalue, repeated eigenvalues
    /// included (Golub & Van Loan, Matrix Computations, section 8.5). NaN and infinities give NaN.
    pub fn new(a: &Sym3) -> Self {
        let mut m = a.to_matrix().to_cols_array_2d();
        let mut v = DMat3::IDENTITY.to_cols_array_2d();
        // Convergence is quadratic and usually takes five sweeps; the limit only ends loops on NaN.
        for _ in 0..20 {
            let off = m[0][1].abs() + m[0][2].abs() + m[1][2].abs();
            if off == 0.0 {
                break;
            }
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                if m[p][q] == 0.0 {
                    continue;
                }
                let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
                // `hypot` would be a library call. Where the square overflows, the angle is zero to rounding.
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                let r = 3 - p - q;
                let (mpq, mrp, mrq) = (m[p][q], m[r][p], m[r][q]);
                m[p][p] -= t * mpq;
                m[q][q] += t * mpq;
                (m[p][q], m[q][p]) = (0.0, 0.0);
                m[r][p] = c * mrp - s * mrq;
                m[r][q] = s * mrp + c * mrq;
                (m[p][r], m[q][r]) = (m[r][p], m[r][q]);
                for k in 0..3 {
                    (v[p][k], v[q][k]) = (c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]);
                }
            }
        }
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| m[i][i].total_cmp(&m[j][j]));
        let [i, j, k] = order;
        Self {
            values: DVec3::new(m[i][i], m[j][j], m[k][k]),
            vectors: DMat3::from_cols(DVec3::from(v[i]), DVec3::from(v[j]), DVec3::from(v[k])),
        }
    }

    /// `sum_a f(values_a) n_a (x) n_a`: the matrix function f(A), for instance logarithm or square root.
    pub fn map(&self, mut f: impl FnMut(f64) -> f64) -> Sym3 {
        let n = self.vectors;
        Sym3::dyad(n.x_axis) * f(self.values.x)
            + Sym3::dyad(n.y_axis) * f(self.values.y)
            + Sym3::dyad(n.z_axis) * f(self.values.z)
    }
}
