//! The force of a flow on bodies that take sub-steps beside it.

mod exchange;

mod drag;

mod late_impulse;

mod force_on_bodies;

mod ringing;

pub use force_on_bodies::add_force_on_bodies;
pub use ringing::damp_ringing;
