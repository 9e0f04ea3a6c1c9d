//! Probes: the motion of the particles of a selection, or a field at a point, as functions of time.

mod body_points;
mod direction;
mod energies;
mod flow;
mod gauge;
mod line;
mod measure;
mod particles;
mod place;
mod planar;
mod point;
mod relative;
mod resolve;
mod shares;
mod stencil;
mod surface;
mod taken;
#[cfg(test)]
mod tests;
mod torque;
mod wear;

pub use energies::EnergyColumns;
pub use flow::{pressure_on_face, water_level};
pub use gauge::Gauge;
pub use resolve::ResolvedProbe;
pub use surface::ForceOfBody;
pub(super) use surface::add_system;
