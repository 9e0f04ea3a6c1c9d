//! The start of a flow: initial state, checks and notes.

mod carried;
mod endless;
mod sound_speed;
mod spread;

pub mod checks;

mod start;

pub mod rest;

mod roofs;

pub mod advice;

pub mod torn_walls;

pub mod stepped;

pub use sound_speed::estimate as estimate_sound_speeds;
pub use start::start;
