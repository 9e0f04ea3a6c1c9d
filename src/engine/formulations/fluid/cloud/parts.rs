//! The parts of the force of a flow whose work is booked.

/// Forces that are kept apart: viscous, and of the pressure of boundaries.
pub const PARTS: usize = 2;

/// Their accounts.
pub const ACCOUNTS: [&str; PARTS] = ["viscosity", "wall_pressure"];
