//! What a flow must not do, looked at in the course of the run.

mod half_space;

mod held_down;

mod intrusion;

mod lost_volume;

mod passing;

mod closed;

mod stabilized;

mod driven;

mod compression;

mod filling;

mod no_gap_pressure;

mod fit;

mod friction;

mod unevenness;

pub mod watch;
