//! Small symmetric matrices, eigenvalues and polar decomposition, which glam does not provide.

mod dyad;
mod eigen;
mod near_identity;
mod polar;
mod root;
mod stretch;
mod sym3;
#[cfg(test)]
mod tests;

pub use dyad::dyad;
pub use eigen::Eigen;
pub use polar::polar;
pub use stretch::{ExtremeValues, extreme_eigenvalues, extreme_stretches};
pub use sym3::Sym3;
