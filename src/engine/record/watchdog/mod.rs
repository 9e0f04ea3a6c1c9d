//! The watchdog: examines every step for conditions that invalidate results, and stops the run or warns.

mod bodies_inside;
mod crossed_planes;
mod domain;
mod energy_growth;
mod free_modes;
mod hourglass;
mod particles_in;
mod passing;
mod remedies;
mod soft_under_pressure;
mod system;
mod wrong_sign;

pub use system::{WATCHDOG, add_system};

#[cfg(test)]
mod tests;
