//! Corrected kernel gradients, which are exact for linear fields.
//!
//! The moment matrix `M_i = sum_j V_j w_ij x_ij (x) x_ij` is the uncorrected gradient of the identity map.
//! The corrected gradient of neighbour j is `g_ij = M_i^-1 w_ij x_ij`, and `sum_j V_j (f_j - f_i) g_ij` is
//! the exact gradient of every linear f for any arrangement of particles (Bonet & Lok 1999, Computer Methods
//! in Applied Mechanics and Engineering 180, 97-115; Ganzenmueller 2015, eq. 9-11, where both signs are the
//! opposite and cancel).

mod affine;
mod moment;
mod moments;
#[cfg(test)]
mod tests;

pub use affine::AffineFit;
pub use moment::{MomentMatrix, SINGULAR};
pub use moments::{add_gradient, add_moment, moment_of};
