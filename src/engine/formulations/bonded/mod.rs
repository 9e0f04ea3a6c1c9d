//! Shared parts of the Lagrangian formulations of solids: neighbour lists of a reference configuration
//! ("bonds"), and the sums over them.
//!
//! In the total-Lagrangian formulation the reference is the initial configuration, in the updated-Lagrangian
//! one it follows the body. The parts are the bonds with weights and moment matrices, the packed particles,
//! the sums for F and the residual, the corrected stress in the frame of a body, cracks, differences of
//! second derivatives, the shares beside held sides, the pass of the internal force, and the pairs for terms
//! of plugins.

mod balance;
mod body_set_up;
mod bond_sum;
mod bonds;
mod cracks;
mod displacement_moment;
mod ellipsoids;
mod frame;
mod gather;
mod held;
mod hessian;
mod internal_force;
mod local_motion;
mod pairs;
mod rows;
mod seen_ellipsoids;
mod support;

pub(super) use balance::{HeldBody, balanced_shares};
pub(super) use body_set_up::{BodySetUp, held_of};
pub(super) use bond_sum::SumOverBonds;
pub(super) use bonds::BodyBonds;
pub use bonds::{BondError, Bonds};
pub(super) use cracks::{CrackEdge, Cracks, EdgeRows, FailureState};
pub(super) use ellipsoids::{Ellipsoid, Ellipsoids};
pub(super) use frame::{AffineFrame, CompleteStress, bodies_of, fill_ghosts, frame_of};
pub(super) use gather::{AddIdentity, CorrectStress, Gather, Written};
pub(super) use held::{HeldParticles, all_shares};
pub(super) use hessian::{BondedSites, FrameIndifferent, HessianBlock, HessianRows};
pub(super) use internal_force::InternalForce;
pub(super) use local_motion::BondedMotion;
pub(super) use pairs::{BodyKernel, BondPairs, BondedRows};
pub use rows::PackedParticle;
pub(super) use rows::pack;
pub(super) use seen_ellipsoids::{FourSeen, OwnEllipsoid, SeenEllipsoid};
pub(super) use support::choose_support;
