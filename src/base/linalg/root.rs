//! Inverse square root of symmetric positive definite matrices.

use super::Sym3;

/// Maximum number of iterations; it is only reached on NaN.
const MAX_ITERATIONS: usize = 20;
/// Squared relative change of the result, below which the next iterate is exact to round-off, as convergence
/// is quadratic.
const SMALL: f64 = 1e-18;

impl Sym3 {
    /// A^(-1/2) of a positive definite matrix, by the coupled iteration of Denman and Beavers (1976, Applied
    /// Mathematics and Computation 2, 63-94), whose iterates are symmetric because all of them have the
    /// principal directions of A. It takes four iterations near the identity, and eight where the ratio of
    /// the eigenvalues is a thousand.
    pub fn inverse_root(&self) -> Self {
        let (mut root, mut inverse) = (*self, Self::IDENTITY);
        for _ in 0..MAX_ITERATIONS {
            let next = (inverse + root.inverse()) * 0.5;
            root = (root + inverse.inverse()) * 0.5;
            let change = next - inverse;
            inverse = next;
            if change.double_dot(&change) <= SMALL * inverse.double_dot(&inverse) {
                break;
            }
        }
        inverse
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Eigen;
    use glam::{DMat3, DVec3};

    #[test]
    fn it_is_that_of_the_eigenvalues() {
        let turn = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.1) * DMat3::from_rotation_y(0.7);
        for values in [[1.0, 1.0, 1.0], [0.9, 1.0, 1.2], [0.003, 1.0, 4.0], [2.0, 2.0, 1.0], [0.4, 0.4, 0.4]]
        {
            let a = Sym3::symmetric_part(
                turn * DMat3::from_diagonal(DVec3::from_array(values)) * turn.transpose(),
            );
            let expected = Eigen::new(&a).map(|value| 1.0 / value.sqrt());
            let found = a.inverse_root();
            assert!((found - expected).norm() < 1e-13 * expected.norm(), "{found:?} {expected:?}");
        }
        assert_eq!(Sym3::IDENTITY.inverse_root(), Sym3::IDENTITY);
        assert!(Sym3 { xx: f64::NAN, ..Sym3::IDENTITY }.inverse_root().xx.is_nan());
    }
}
