//! Time integration: kick, drift, kick for every phase, with the work of constraints and gravity booked.

mod fours;
mod leapfrog;

pub(crate) use leapfrog::constrained;
pub use leapfrog::{DRIFT, KICK, OwnMotion, add_systems};
