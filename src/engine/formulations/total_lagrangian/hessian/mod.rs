//! Stabilization by differences of second derivatives, over the bonds of a reference configuration.
//!
//! Both forms compare a second derivative of the positions with the gradient of their gradient, and their forces are the exact adjoints. A neighbour has what
//! the adjoint needs from the other end of the bond: the pair weight is symmetric, and everything else belongs to one particle.

mod frame_indifferent;
mod rows;
mod vidal_2007;

pub(in crate::formulations) use frame_indifferent::FrameIndifferent;
pub(in crate::formulations) use rows::{HessianBlock, HessianRows};
