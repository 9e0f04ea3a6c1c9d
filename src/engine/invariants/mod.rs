//! Exact properties of every formulation of solids and every stabilizer, for their tests: an affine map has
//! its deformation gradient, forces are the gradient of the stored energy with zero resultant and torque, and
//! a thrown body conserves momentum and angular momentum.
//!
//! The formulation is a parameter: [`Specimen::new`] takes whatever makes a simulation whose first body is
//! the specimen, irregular as a rule.

#[cfg(test)]
mod drawn_tests;
mod momenta;
mod specimen;
#[cfg(test)]
mod tests;

pub use momenta::{ConservationError, Momenta};
pub use specimen::{Affine, ForceSlope, NetForce, Specimen};
