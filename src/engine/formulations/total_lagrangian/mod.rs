//! Total-Lagrangian smoothed particle hydrodynamics of solids (Ganzenmueller 2015).
//!
//! Neighbours, weights and corrections belong to the reference configuration and are built once. A step is two passes
//! over pairs: the first makes F and, block by block while the rows are in cache, the stress and the pair stress;
//! the second the force.

mod bond_terms;
mod bonds;
mod constitutive;
mod cracks;
mod damping;
mod deformation;
mod edges;
mod families;
mod fields;
mod formulation;
mod frame;
mod gather;
mod images;
mod internal_force;
mod pairs;
mod refit;
mod removed;
mod repeats;
mod rows;
mod spread;
mod stable_step;
#[cfg(test)]
mod state_tests;
mod stretches;
mod support;

pub use bond_terms::{BodyBondTerm, BondEnergy, BondMemory, BondRows, BondTerm};
pub use bonds::{BondError, Bonds};
pub(crate) use damping::DampedBodies;
pub(crate) use families::{Surroundings, packed_rows};
pub(crate) use formulation::PackedRows;
pub use formulation::{INTERNAL_FORCE, TotalLagrangian};
pub use images::Images;
pub(crate) use images::MirrorPlane;
pub use rows::{PairStress, PairStressRows, Site};
