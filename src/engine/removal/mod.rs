//! Particles removed from a run: those outside the domain, and those selected by a rule of a plugin.

mod domain;
mod leaving;
mod rule;
mod system;
#[cfg(test)]
mod tests;

pub(crate) use domain::DomainBox;
pub(crate) use leaving::{LEAVING, LeavingParticles};
pub use rule::RemovalRule;
pub use system::{REMOVAL, REMOVED_ENERGY, add_system};
