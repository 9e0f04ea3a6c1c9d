//! Cases K and M: exact properties of kernels, neighbours, forces and laws.

pub mod homogeneous;
pub mod invariants;
pub mod jaumann_shear;
pub mod johnson_cook;
pub mod kernels;
pub mod laws;
pub mod neighbor_lists;
pub mod uniaxial_strain;
