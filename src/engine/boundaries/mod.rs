//! Conditions: supports, prescribed motion and loads. A condition is one file and one line of [`register`].

mod beside_held;
mod body_force;
mod broken_skin;
mod displacement;
mod driven_fluids;
mod face_area;
mod field;
mod fix;
mod flow_load;
mod force;
#[cfg(test)]
mod image_tests;
mod initial_displacement;
mod initial_velocity;
mod joined_side;
#[cfg(test)]
mod joined_side_tests;
mod jumps;
mod load;
mod load_law;
mod mean_velocity;
#[cfg(test)]
mod mean_velocity_tests;
mod on_rigid;
mod part;
mod prescribed;
mod pressure;
mod pulses;
#[cfg(test)]
mod pulses_tests;
mod relaxation_zone;
mod rigid_part;
mod rotation_rate;
mod skin_load;
#[cfg(test)]
mod space_tests;
#[cfg(test)]
mod surface_tests;
mod symmetry;
#[cfg(test)]
mod tests;
mod traction;
mod turning;
#[cfg(test)]
mod turning_tests;
mod velocity;
mod zone_box;
mod zone_checks;
mod zone_flow;
#[cfg(test)]
mod zone_tests;

pub use body_force::BodyForce;
pub use displacement::Displacement;
pub use fix::Fix;
pub use force::TotalForce;
pub use initial_displacement::{DisplacedBodies, InitialDisplacement};
pub use initial_velocity::{GivenVelocities, InitialVelocity};
pub use mean_velocity::MeanVelocity;
pub use pressure::PressureLoad;
pub use relaxation_zone::RelaxationZone;
pub use rotation_rate::PrescribedRotation;
pub use symmetry::{Side, Symmetry};
pub use traction::Traction;
pub use velocity::{MAX_MACH, PrescribedVelocity};

use crate::plugin::Registry;

/// Registers all conditions of the engine.
pub fn register(registry: &mut Registry) {
    registry
        .condition::<Fix>()
        .condition::<PrescribedVelocity>()
        .condition::<Displacement>()
        .condition::<InitialDisplacement>()
        .condition::<InitialVelocity>()
        .condition::<Traction>()
        .condition::<PressureLoad>()
        .condition::<TotalForce>()
        .condition::<BodyForce>()
        .condition::<MeanVelocity>()
        .condition::<RelaxationZone>()
        .condition::<Symmetry>()
        .condition::<PrescribedRotation>();
}
