//! The rotation around each particle, which friction must not feel.

mod spin;

mod body_spin;

mod couples;

pub use couples::Couples;
pub use spin::Spin;
