//! Contact laws: the trait, and one file for each law.

mod law;

mod penalty;

mod hertz;

mod restitution;

mod registry;

pub use hertz::{Hertz, PlaneForce};
pub use law::{ContactLaw, ContactPair, NormalForce, Spring, Touch};
pub use penalty::Penalty;
pub use restitution::{damping_ratio, restitution};
