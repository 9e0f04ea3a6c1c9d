//! The two passes over pairs: the rate of compression, and the force.

mod pair_sums;

mod pair_force;

pub mod blocks;

mod compression;

mod force;

mod of_group;

mod reaction;

pub use compression::Compression;
pub use force::{FLUID_FORCE, FlowForce, friction_on, reads_flow};
pub use reaction::Reaction;
