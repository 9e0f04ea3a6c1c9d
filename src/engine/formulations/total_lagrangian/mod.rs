//! Total-Lagrangian smoothed particle hydrodynamics of solids (Ganzenmueller 2015).
//!
//! Neighbours, weights and corrections belong to the reference configuration and are built once. A step is
//! two passes over pairs. The first computes F and, block by block while the rows are in cache, the stress
//! and the corrected stress; the second computes the force.

mod deformation;
mod edges;
mod formulation;
mod internal_force;
mod phase;
mod removal;
mod removed;
mod set_up;
#[cfg(test)]
mod state_tests;
mod system;

pub use formulation::TotalLagrangian;
