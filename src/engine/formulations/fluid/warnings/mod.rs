//! Warnings of flows during a run.

mod fallen;

mod half_space;

mod held_down;

mod intrusion;

mod lost_volume;

mod passing;

mod closed;

mod spreading;

mod stabilized;

mod stairs;

mod stretched;

mod surroundings;

mod driven;

mod compression;

mod filling;

mod no_gap_pressure;

mod fit;

mod friction;

mod torques;

mod tension;
pub use tension::Tension;

mod unevenness;

pub mod watch;
