//! Total-Lagrangian smoothed particle hydrodynamics of solids (Ganzenmueller 2015).
//!
//! Neighbours, weights and corrections belong to the reference configuration and are built once. A step is two passes
//! over pairs. The first computes F and, block by block while the rows are in cache, the stress and the corrected stress;
//! the second computes the force.

mod balance;
mod bond_sum;
mod bonds;
mod cracks;
mod deformation;
mod edges;
mod formulation;
mod frame;
mod gather;
mod held;
mod hessian;
mod internal_force;
mod pairs;
mod phase;
mod reach;
mod removal;
mod removed;
mod rows;
mod set_up;
mod spread;
#[cfg(test)]
mod state_tests;
mod support;
mod system;

pub(super) use balance::{HeldBody, balanced_shares};
pub use bonds::{BondError, Bonds};
pub(super) use cracks::Cracks;
pub use formulation::TotalLagrangian;
pub(super) use frame::{AffineFrame, CompleteStress, bodies_of, fill_ghosts, frame_of};
pub(super) use gather::{CorrectStress, Gather, Written};
pub(super) use held::{HeldParticles, all_shares};
pub(super) use hessian::{BondedSites, FrameIndifferent, HessianBlock, HessianRows};
pub(super) use internal_force::InternalForce;
pub(super) use pairs::{BodyKernel, BondPairs, BondedRows};
pub(super) use reach::{Ellipsoid, Ellipsoids};
pub use rows::PackedParticle;
pub(super) use set_up::{BodySetUp, held_of};
pub(super) use spread::fit;
