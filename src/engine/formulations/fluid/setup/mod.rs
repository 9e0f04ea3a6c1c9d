//! The start of a flow: initial state, checks and notes.

mod sound_speed;

pub mod checks;

mod start;

pub mod rest;

pub mod advice;

pub use sound_speed::estimate as estimate_sound_speeds;
pub use start::start;
