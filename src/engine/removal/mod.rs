//! Particles removed from a run: those outside the domain, and those selected by a rule of a plugin.

mod domain;
mod leaving;
mod rule;
mod system;
#[cfg(test)]
mod tests;

pub use crate::schedule::REMOVED_ENERGY;
pub(crate) use domain::DomainBox;
pub(crate) use leaving::{LEAVING, LeavingParticles};
pub use rule::RemovalRule;
pub use system::{REMOVAL, add_system};
