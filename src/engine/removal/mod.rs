//! Particles removed from a run: those outside the domain, and those selected by a rule of a plugin.

mod domain;
mod leaving;
mod system;
#[cfg(test)]
mod tests;

pub(crate) use domain::DomainBox;
pub(crate) use leaving::Leaving;
pub use system::{REMOVAL, REMOVED_ENERGY, RemovalRule, add_system};
