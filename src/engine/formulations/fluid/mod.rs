//! Weakly compressible fluids, and the walls that bound them.
//!
//! A step is two passes over pairs: the rate of compression at the middle of the step gives density and pressure at its
//! end, then pressure and viscosity give the force. Between the two, walls take their pressure from the fluid beside
//! them (Adami, Hu, Adams, J. Comput. Phys. 231 (2012) 7057-7075). Fluids and boundaries are packed into one cloud with
//! one search for neighbours; every pair force has its exact opposite on the other particle.

mod advice;
mod assemble;
mod axial;
mod batch;
mod blocks;
mod body_motion;
mod body_spin;
mod cells;
#[cfg(test)]
mod channel_tests;
mod checks;
mod cloud;
mod compression;
mod couples;
mod coupling;
mod density;
mod displace;
mod drag;
mod drift;
mod exchange;
mod fields;
mod filling;
mod fit;
mod force;
mod formulation;
mod friction;
mod intrusion;
mod kernel;
mod late_impulse;
mod loads;
#[cfg(test)]
mod loads_tests;
mod mach;
mod near;
mod near_rows;
mod neighbors;
#[cfg(test)]
mod noticing_tests;
mod pack;
mod pair_force;
mod pair_sums;
mod pairs;
mod passing;
mod reaction;
mod record;
mod repay;
mod repulsion;
#[cfg(test)]
mod repulsion_tests;
mod rest;
#[cfg(test)]
mod rest_tests;
mod ringing;
#[cfg(test)]
mod ringing_tests;
#[cfg(test)]
mod several_tests;
mod sides;
mod sort;
mod sound_speed;
mod spin;
#[cfg(test)]
mod spin_tests;
mod spread;
mod start;
mod state;
mod surface_distance;
mod surroundings;
mod systems;
#[cfg(test)]
mod tests;
mod thickness;
#[cfg(test)]
mod thin_tests;
mod unevenness;
mod viscosities;
mod wall;
mod wall_pressure;
mod wall_state;
mod watch;
#[cfg(test)]
mod worn_tests;

pub use assemble::add_systems;
pub use blocks::keep_rows;
pub use cloud::{FlowCloud, FluidState, Group, Near, Role, Surface};
pub use density::{DensityShift, SHIFTING_ENERGY};
pub use displace::displace;
pub(crate) use fields::fields;
pub use formulation::Fluid;
pub use kernel::FluidKernel;
pub use near::{FourNear, Fours, RowPass};
pub use record::Record;
pub use repay::Repayment;
pub use ringing::damp_ringing;
pub use sound_speed::estimate as estimate_sound_speeds;
pub use surroundings::{SmallestEigenvalue, smallest_eigenvalue};
pub use wall::{Slip, Wall};
