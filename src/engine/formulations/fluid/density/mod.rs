//! Density, pressure and Mach number of fluids.

mod continuity;

mod floor;

mod mach;

mod pressure_factor;

mod state;

pub use continuity::{Continuity, DensityShift, DisplacementAccount, SHIFTING_ENERGY};
pub use floor::{Floor, open_gravity};
pub use mach::{relative_speed, wall_frame};
pub use pressure_factor::PressureFactor;
pub use state::ApplyState;
