//! Particles that are taken out of a run: those outside of the domain, and those that a rule of a plugin names.

mod domain;
mod system;
#[cfg(test)]
mod tests;

pub(crate) use domain::DomainBox;
pub use system::{REMOVAL, REMOVED_ENERGY, RemovalRule, add_system};
