//! Stabilization by differences of second derivatives, over the bonds of a reference configuration.
//!
//! Both forms compare a second derivative of the positions with the gradient of their gradient, and their
//! forces are the exact adjoints. The pair weight is symmetric and all other factors belong to one particle,
//! so that the adjoint needs no data from the other end of a bond.

mod frame_indifferent;
mod rows;
mod vidal_2007;
mod vidal_adjoint;

pub(in crate::formulations) use frame_indifferent::FrameIndifferent;
pub(in crate::formulations) use rows::{BondedSites, HessianBlock, HessianRows};
