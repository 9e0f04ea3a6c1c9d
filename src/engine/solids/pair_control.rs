//! Hourglass control along pairs, as a plugin requests it for bodies whose weights live in the current
//! configuration. The formulation computes it with its own neighbours.

use super::folded::FoldedEnergy;
use crate::plugin::SimBuilder;
use crate::schedule::{AccountKind, Ledger};
use crate::world::{BodyId, BodySet};

/// The control of some bodies: `U_i = 1/4 E_i V_0,i sum_j V_0,j w_ij [xi s_ij^2 + across min(E_i, E_j)/E
/// (|e_ij|^2 - s_ij^2)]` with the error `e_ij = F_i X_ij - x_ij` of the mean deformation since the start, and
/// its part along the pair, `s_ij = e_ij . x_ij / |x_ij|`. E is Young's modulus of the material, E_i is in
/// the column [`HourglassModulus`](crate::world::HourglassModulus); where it is zero the particle has failed,
/// and its pairs store nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairControl {
    /// Coefficient xi of the error along a pair, above zero \[1\].
    pub xi: f64,
    /// Coefficient of the error across it, of two particles that resist with Young's modulus \[1\].
    pub across: f64,
}

impl PairControl {
    /// Adds the control to bodies. A body whose formulation does not offer it is an error of the scene.
    pub fn add(self, bodies: BodySet, sim: &mut SimBuilder<'_>) {
        sim.extend_bodies(bodies, "hourglass control along pairs", self);
    }
}

/// Account of the energy that control holds.
const ACCOUNT: &str = "hourglass";
/// Account of the energy released without work, by softening of the material.
const RELEASED: &str = "hourglass_released";

/// Books the energy of a body.
pub(super) fn book(energy: FoldedEnergy, softens: bool, body: BodyId, ledger: &mut Ledger) {
    let account = ledger.account(ACCOUNT, AccountKind::Stored);
    ledger.set(account, body, energy.stored);
    if softens {
        let released = ledger.account(RELEASED, AccountKind::Dissipated);
        ledger.add(released, body, energy.released);
    }
}
