//! The passes over pairs in blocks of eight particles and single precision.
//!
//! A lane is a particle i. A block has one list of neighbours; each neighbour j is read once, put in all
//! lanes, and weighs nothing where it is beyond the support. So nothing is gathered, transposed or summed
//! across lanes, and the lists are an eighth as long. State, density, pressure and the energy balance stay in
//! double precision: only differences of place, velocity and pressure between neighbours, and the sums over
//! them, are single. Every pair force has its exact opposite on the other particle.

mod choose;
mod compression;
mod force;
mod land;
mod pairs;
mod rows;
#[cfg(test)]
mod tests;

pub use choose::choose;
pub use force::BlockForce;
