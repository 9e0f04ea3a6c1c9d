//! Particles removed from a run: those outside the domain, and those selected by a rule of a plugin.

mod domain;
mod system;
#[cfg(test)]
mod tests;

pub(crate) use domain::DomainBox;
pub use system::{REMOVAL, REMOVED_ENERGY, RemovalRule, add_system};
