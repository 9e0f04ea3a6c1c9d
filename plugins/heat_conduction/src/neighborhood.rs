//! The weight of a pair along its direction, so that a particle conducts as a continuum does.
//!
//! Heat is conducted alike along all axes where `sum_j V_j w_ij g_i(x_ij) x_ij (x) x_ij` is the identity:
//! sums over neighbours are then exact for quadratic temperatures, whatever their places. With
//! `M = sum_j V_j w_ij x_ij (x) x_ij`, in d dimensions,
//!
//! `g = 1/2 [(d + 2) (x . M^-2 x) / (x . M^-1 x) - tr M^-1] + (x . C x) / (x . M^-1 x)`.
//!
//! The first part is exact for the affine image of an isotropic neighbourhood, and one where M is the
//! identity. The symmetric C makes up for what a lattice, which is not isotropic, and a surface leave.

use meshless_engine::correction::MomentMatrix;
use meshless_engine::glam::DVec3;
use meshless_engine::linalg::Sym3;

/// Minimum determinant of a moment matrix that shows a shape: below it the neighbourhood counts as round.
const SINGULAR: f64 = 0.02;
/// Smallest pivot of the equations of C, over their diagonal, with which they are solved: neighbours in one
/// row or in one plane do not determine it, and few neighbours, as of debris, hardly do. Corners of intact
/// bodies have 0.27 and more.
const DETERMINED: f64 = 0.1;
/// Numbers of a symmetric matrix in space.
const COMPONENTS: usize = 6;

/// The neighbourhood of a particle.
#[derive(Clone, Copy)]
pub(crate) struct ConductingNeighborhood {
    /// M^-1.
    inverse: Sym3,
    /// C.
    correction: Sym3,
}

impl ConductingNeighborhood {
    /// Of no neighbours.
    pub const NONE: Self = Self { inverse: Sym3::ZERO, correction: Sym3::ZERO };

    /// The neighbourhood of the pairs, each with V_j w_ij and its vector, that `pairs` hands to a function,
    /// in a space of `axes` dimensions.
    pub fn new(axes: usize, pairs: impl Fn(&mut dyn FnMut(f64, DVec3))) -> Self {
        let mut moment = MomentMatrix::new(axes);
        pairs(&mut |weight, x| moment.add(weight, x));
        let mean = moment.matrix().trace() / axes as f64;
        let round = || if mean > 0.0 { Sym3::IDENTITY * (1.0 / mean) } else { Sym3::ZERO };
        let inverse = moment.inverse_above(SINGULAR).unwrap_or_else(round);
        let mut found = Self { inverse, correction: Sym3::ZERO };
        let mut equations = CorrectionEquations::new(axes);
        pairs(&mut |weight, x| {
            let along = x.dot(inverse * x);
            if along > 0.0 {
                equations.add(weight, found.weight(axes, x), along, x);
            }
        });
        found.correction = equations.solution().unwrap_or(Sym3::ZERO);
        found
    }

    /// g along a pair vector.
    pub fn weight(&self, axes: usize, x: DVec3) -> f64 {
        let y = self.inverse * x;
        let along = x.dot(y);
        if along <= 0.0 {
            return 0.0;
        }
        let inverse = &self.inverse;
        let trace = if axes == 2 { inverse.xx + inverse.yy } else { inverse.trace() };
        let corrected = x.dot(self.correction * x) / along;
        0.5 * ((axes as f64 + 2.0) * y.length_squared() / along - trace) + corrected
    }
}

/// The equations `sum_j V_j w_ij (x . C x) / (x . M^-1 x) x (x) x = I - sum_j V_j w_ij g x (x) x` of C, in
/// the components of symmetric matrices, off the diagonal times the root of two: with them they are positive
/// definite.
struct CorrectionEquations {
    /// Number of components that the space has.
    size: usize,
    axes: usize,
    matrix: [[f64; COMPONENTS]; COMPONENTS],
    right: [f64; COMPONENTS],
}

impl CorrectionEquations {
    fn new(axes: usize) -> Self {
        let mut right = [0.0; COMPONENTS];
        right[..axes].fill(1.0);
        Self { size: axes * (axes + 1) / 2, axes, matrix: [[0.0; COMPONENTS]; COMPONENTS], right }
    }

    /// The components of x (x) x.
    fn components(&self, x: DVec3) -> [f64; COMPONENTS] {
        const ROOT: f64 = std::f64::consts::SQRT_2;
        if self.axes == 2 {
            return [x.x * x.x, x.y * x.y, ROOT * x.x * x.y, 0.0, 0.0, 0.0];
        }
        [x.x * x.x, x.y * x.y, x.z * x.z, ROOT * x.x * x.y, ROOT * x.x * x.z, ROOT * x.y * x.z]
    }

    fn add(&mut self, weight: f64, shape: f64, along: f64, x: DVec3) {
        let t = self.components(x);
        for a in 0..self.size {
            let share = weight * t[a];
            self.right[a] -= share * shape;
            for b in 0..=a {
                self.matrix[a][b] += share * t[b] / along;
            }
        }
    }

    /// C, by Cholesky's method; none where the neighbours do not determine it.
    fn solution(mut self) -> Option<Sym3> {
        let (size, l, r) = (self.size, &mut self.matrix, &mut self.right);
        for a in 0..size {
            let whole = l[a][a];
            for b in 0..=a {
                let known: f64 = (0..b).map(|k| l[a][k] * l[b][k]).sum();
                let rest = l[a][b] - known;
                if a > b {
                    l[a][b] = rest / l[b][b];
                } else if rest > DETERMINED * whole {
                    l[a][a] = rest.sqrt();
                } else {
                    return None;
                }
            }
            let known: f64 = (0..a).map(|k| l[a][k] * r[k]).sum();
            r[a] = (r[a] - known) / l[a][a];
        }
        for a in (0..size).rev() {
            let known: f64 = (a + 1..size).map(|k| l[k][a] * r[k]).sum();
            r[a] = (r[a] - known) / l[a][a];
        }
        let off = std::f64::consts::FRAC_1_SQRT_2;
        let c = &self.right;
        Some(if self.axes == 2 {
            Sym3 { xx: c[0], yy: c[1], xy: off * c[2], ..Sym3::ZERO }
        } else {
            Sym3 { xx: c[0], yy: c[1], zz: c[2], xy: off * c[3], xz: off * c[4], yz: off * c[5] }
        })
    }
}
