//! Weakly compressible fluids, and the walls that bound them.
//!
//! A step is two passes over pairs: the rate of compression at the middle of the step gives density and
//! pressure at its end, then pressure and viscosity give the force. Between the two, walls take their
//! pressure from the fluid beside them (Adami, Hu, Adams, J. Comput. Phys. 231 (2012) 7057-7075). Fluids and
//! boundaries are packed into one cloud with one search for neighbours; every pair force has its exact
//! opposite on the other particle.
//!
//! The folders are listed in the order of their dependencies, and import only those above them.

/// Records and arithmetic of the passes over neighbours, for four of them at once.
mod lanes;

/// The lists of neighbours.
mod lists;

/// All particles of a flow as one cloud.
mod cloud;

/// Density and pressure of fluids.
mod density;

/// The rotation around each particle, which friction must not feel.
mod rotation;

/// Where the forces on boundaries act: at their surface.
mod moments;

/// Boundaries of a fluid.
mod walls;

/// The two passes over pairs: the rate of compression, and the force.
mod passes;

/// The force of a flow on bodies that take sub-steps beside it.
mod coupling;

/// Support for plugins that stabilize a flow.
mod stabilizers;

/// The parameters of a fluid.
mod formulation;

/// The start of a flow.
mod setup;

/// Warnings of flows during a run.
mod warnings;

/// Fields that show a flow.
mod fields;

/// The systems of the step.
mod systems;

/// From the fluids and walls of a scene to these systems.
mod assemble;

#[cfg(test)]
mod tests;

pub use assemble::add_systems;
pub(crate) use cloud::FLOW_LOADS;
pub use cloud::FLOW_RECORDS;
pub use cloud::{ArrangementPass, NearPairs, RowPass, RowSums, smallest_eigenvalue};
pub use cloud::{BoundarySurface, FlowCloud, FluidState, Group, Near, Role};
pub use coupling::{CouplingForce, damp_sub_cycled_bodies};
pub use density::{DensityShift, DisplacementAccount, SHIFTING_ENERGY};
pub(crate) use fields::fields;
pub use formulation::Fluid;
pub use lanes::{FlowParticle, FluidKernel};
pub use passes::Reaction;
pub use setup::estimate_sound_speeds;
pub use stabilizers::{Interior, Repayment, displace};
pub use walls::{Slip, Wall};
pub use warnings::Tension;
