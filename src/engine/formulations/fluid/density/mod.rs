//! Density, pressure and Mach number of fluids.

mod continuity;

mod mach;

mod state;

pub use continuity::{Continuity, DensityShift, DisplacementAccount, SHIFTING_ENERGY};
pub use mach::{relative_speed, wall_frame};
pub use state::ApplyState;
