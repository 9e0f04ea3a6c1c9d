//! Stabilization by the difference of two second derivatives of the positions, as a plugin requests it for
//! bodies. The formulation computes it with its own neighbours and weights.
//!
//! Motions that do not change the averaged gradient change a second derivative of the positions, but not the
//! gradient of the gradient. The difference vanishes for affine motions, decreases with the spacing for
//! smooth ones, and is resisted.

use glam::DVec3;

use super::folded::FoldedEnergy;
use crate::parallel::BlockSum;
use crate::plugin::SimBuilder;
use crate::world::BodySet;

/// How the difference is resisted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HessianForm {
    /// The difference of Laplacians d_i stores the energy `eta^2 E_i V_i |d_i|^2 / 2`.
    FrameIndifferent,
    /// The gradient has the difference times a vector with the smoothing length in every component added
    /// (Vidal, Bonet, Huerta 2007, eq. 17).
    Vidal2007,
}

/// The stabilization of some bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HessianDifference {
    /// Coefficient eta \[1\].
    pub eta: f64,
    /// Form.
    pub form: HessianForm,
}

impl HessianDifference {
    /// Adds the stabilization to bodies. A body whose formulation does not offer it is an error of the scene.
    pub fn add(self, bodies: BodySet, sim: &mut SimBuilder<'_>) {
        sim.extend_bodies(bodies, "a stabilization by differences of second derivatives", self);
    }
}

crate::column! {
    /// Difference of Laplacians times the smoothing length, as it was last resisted.
    pub struct HessianResidual(DVec3) = "hessian_residual", "d", "1";
    /// Stiffness `eta^2 E V` that it was resisted with.
    pub struct HessianStiffness(f64) = "hessian_stiffness", "kappa", "J";
}

/// Account of the energy of the frame-indifferent form.
pub(super) const ACCOUNT: &str = "hessian";
/// Account of the energy released without work, by softening of the material.
pub(super) const RELEASED: &str = "hessian_released";

impl BlockSum for FoldedEnergy {
    fn add(&mut self, next: &Self) {
        self.stored += next.stored;
        self.released += next.released;
    }
}
