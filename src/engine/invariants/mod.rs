//! What holds exactly of every formulation of solids and every stabilizer, for their tests: an affine map has
//! its deformation gradient, forces are the slope of the stored energy and have neither a sum nor a torque,
//! and a body that is thrown keeps its momenta.
//!
//! The formulation is a parameter: [`Specimen::new`] takes whatever makes a simulation whose first body is
//! the specimen, irregular as a rule.

#[cfg(test)]
mod drawn_tests;
mod momenta;
mod specimen;
#[cfg(test)]
mod tests;

pub use momenta::{Momenta, Thrown};
pub use specimen::{Affine, ForceSlope, NetForce, Specimen};
