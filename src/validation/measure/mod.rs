//! Measurements and runs of cases.

mod disorder;
mod energy;
mod motion;
mod random;
mod record;
mod rigid;
mod runs;

pub use disorder::Disorder;
pub use energy::{Balance, Kind};
pub use motion::{MaterialPoint, body, momentum, rounded_forces};
pub use random::Random;
pub use record::{Record, rows};
pub use rigid::state;
pub use runs::{relax, run, run_until};
