//! Probes: what the particles of a selection do, or a field at a point, as functions of time.

mod energies;
mod flow;
mod measure;
mod particles;
mod point;
mod resolve;
mod torque;

pub use energies::EnergyColumns;
pub use flow::pressure_on_face;
pub use resolve::{Gauge, Probe};
