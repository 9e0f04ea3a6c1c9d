//! The divergence operator: force from stress.

use glam::DMat3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::near::NearbyMotion;
use super::particle::EulerianParticle;

/// Divergence operator: force from stress.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Divergence {
    /// The exact adjoint of the velocity gradient: momentum, angular momentum and power of the stress are
    /// kept.
    #[default]
    Adjoint,
    /// That of the paper (eqs. 10-11), with stresses over the sum of the kernel: momentum is kept, angular
    /// momentum and energy are not.
    Shepard,
}

/// Record of the Kirchhoff stress of a particle of that mass for its neighbours.
#[inline(always)]
pub(super) fn corrected(
    divergence: Divergence,
    stress: &DMat3,
    around: &NearbyMotion,
    mass: f64,
    point: &EulerianParticle,
) -> DMat3 {
    match divergence {
        Divergence::Adjoint => *stress * around.inverse_moment.to_matrix(),
        Divergence::Shepard => {
            let (reference, volume) = (point.place.0[3], point.velocity.0[3]);
            let density = mass / volume;
            *stress * (reference / (volume * density * density * around.filled))
        }
    }
}
