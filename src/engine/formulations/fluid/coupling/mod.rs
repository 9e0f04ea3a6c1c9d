//! The force of a flow on bodies that take sub-steps beside it.

mod exchange;

mod drag;

mod correction_impulse;

mod force_on_bodies;

mod frozen;

mod light_body;

mod sub_cycled;

pub use exchange::CouplingForce;
pub use force_on_bodies::add_force_on_bodies;
pub use sub_cycled::damp_sub_cycled_bodies;
