//! Moment matrix of a row of a neighbour list, and its inverse.

use crate::linalg::Sym3;
use crate::parallel::Lanes4;
use glam::DVec3;

/// Minimum determinant of a moment matrix in units of `(tr M / d)^d`. Below it the neighbours are too few, or
/// are collinear (in three dimensions coplanar) to within about a thousandth of their distance.
pub const SINGULAR: f64 = 1e-6;

/// `M_i = sum_j V_j w_ij x_ij (x) x_ij`, dimensionless. It is near the identity inside a body and about half
/// of it at a free surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentMatrix {
    matrix: Sym3,
    dimension: usize,
}

impl MomentMatrix {
    /// The zero matrix, in 1, 2 or 3 dimensions.
    #[inline]
    pub const fn new(dimension: usize) -> Self {
        Self { matrix: Sym3::ZERO, dimension }
    }

    /// The matrix of a given sum.
    #[inline]
    pub const fn of(matrix: Sym3, dimension: usize) -> Self {
        Self { matrix, dimension }
    }

    /// The matrix of the given columns, whose number is the dimension.
    #[inline(always)]
    pub fn of_columns<const D: usize>(columns: &[Lanes4; D]) -> Self {
        let [x, y] = [columns[0].0, columns[1].0];
        let plane = Sym3 { xx: x[0], yy: y[1], xy: x[1], ..Sym3::ZERO };
        let solid = |z: &Lanes4| Sym3 { zz: z.0[2], xz: z.0[0], yz: z.0[1], ..plane };
        Self::of(columns.get(2).map_or(plane, solid), D)
    }

    /// Adds a neighbour by `V_j w_ij` (m^-2) and `x_ij` (m); for a reproducible sum neighbours are added in
    /// the order of their row.
    #[inline]
    pub fn add(&mut self, volume_weight: f64, x_ij: DVec3) {
        self.matrix += Sym3::dyad(x_ij) * volume_weight;
    }

    /// The sum so far.
    #[inline]
    pub const fn matrix(&self) -> &Sym3 {
        &self.matrix
    }

    /// The correction matrix `M_i^-1`, with zeros along axes beyond the dimension: corrected gradients stay
    /// on the line or in the plane. `None` where the moment matrix is singular, see [`SINGULAR`], or not
    /// finite: such a particle has no deformation gradient and no stress.
    #[inline]
    pub fn inverse(&self) -> Option<Sym3> {
        self.inverse_above(SINGULAR)
    }

    /// The correction matrix with another minimum determinant, in units of `(tr M / d)^d`.
    #[inline]
    pub fn inverse_above(&self, least: f64) -> Option<Sym3> {
        let m = &self.matrix;
        let (determinant, mean, inverse) = match self.dimension {
            1 => (m.xx, m.xx, Sym3 { xx: 1.0 / m.xx, ..Sym3::ZERO }),
            2 => {
                let determinant = m.xx * m.yy - m.xy * m.xy;
                let scale = 1.0 / determinant;
                let inverse = Sym3 { xx: m.yy * scale, yy: m.xx * scale, xy: -m.xy * scale, ..Sym3::ZERO };
                (determinant, 0.5 * (m.xx + m.yy), inverse)
            }
            _ => (m.determinant(), m.trace() / 3.0, m.inverse()),
        };
        let limit = least * mean.powi(self.dimension.clamp(1, 3) as i32);
        // Strictly greater, because both sides are zero without neighbours; the comparison rejects NaN too.
        (determinant > limit && determinant.is_finite()).then_some(inverse)
    }
}
