//! Least-squares fit of an affine map to the displacements of the neighbours of a particle.

use glam::{DMat3, DVec3};

use super::moment::MomentMatrix;
use crate::linalg::dyad;

/// Sums over the neighbours of a particle for the fitted displacement gradient `(sum_j V_j w_ij u_ij
/// (x) X_ij) M_i^-1`.
#[derive(Clone, Copy, Debug)]
pub struct AffineFit {
    moment: MomentMatrix,
    spread: DMat3,
}

impl AffineFit {
    /// An empty sum, in 2 or 3 dimensions.
    pub const fn new(dimension: usize) -> Self {
        Self { moment: MomentMatrix::new(dimension), spread: DMat3::ZERO }
    }

    /// Adds a neighbour by its weight V_j w_ij (m^-2), its vector X_ij in the reference configuration (m) and
    /// its relative displacement `u_ij = x_ij - X_ij` (m).
    pub fn add(&mut self, weight: f64, reference: DVec3, change: DVec3) {
        self.moment.add(weight, reference);
        self.spread += dyad(change, reference * weight);
    }

    /// The displacement gradient F - I; `None` where the moment matrix is singular.
    pub fn gradient(&self) -> Option<DMat3> {
        Some(self.spread * self.moment.inverse()?.to_matrix())
    }
}
