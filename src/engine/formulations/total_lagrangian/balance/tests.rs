//! The least squares behind the shares; what these do is tested where supports are placed.

use super::least_squares::{SparseRows, solve};

#[test]
fn the_damped_solution_is_that_of_the_normal_equations() {
    // Rows (1, 2), (3, -1), (0, 1), right-hand side (1, 2, 3), damping 0.5 and 1: (A^T A + diag(0.25, 1)) x = A^T b.
    let mut a = SparseRows::default();
    for row in [&[(0, 1.0), (1, 2.0)][..], &[(0, 3.0), (1, -1.0)], &[(1, 1.0)]] {
        row.iter().for_each(|(column, value)| a.add(*column, *value));
        a.end();
    }
    let x = solve(&a, &[1.0, 2.0, 3.0], &[0.5, 1.0]);
    // A^T A = (10, -1; -1, 6), A^T b = (7, 3).
    let determinant = 10.25 * 7.0 - 1.0;
    let exact = [(7.0 * 7.0 + 3.0) / determinant, (10.25 * 3.0 + 7.0) / determinant];
    assert!((x[0] - exact[0]).abs() < 1e-6 && (x[1] - exact[1]).abs() < 1e-6, "{x:?} {exact:?}");
}
