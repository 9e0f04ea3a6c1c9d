//! Points of the material beside a particle: their motion, and the effect of a force on them.
//!
//! The deformation gradient of a particle is a weighted sum over its neighbours, and so is the motion of the
//! material point at X_i + A, with a short vector A of the reference configuration:
//!
//! ```text
//! v(X_i + A) = v_i + F'_i A = v_i + sum_j c_j (v_j - v_i),      c_j = V_j w_ij X_ij . M_i^-1 A
//! ```
//!
//! A force f on the point acts on the particles with the same weights. Its power is then that on the motion
//! of the point and, because the sum of c_j x_ij is F_i A, its moment is that of a force at x_i + F_i A. Its
//! effect on the neighbours and on the particle equals that of a stress `P_i = -f (x) A / V_i` in the
//! particle: it is added to the stress that the pass of the internal force reads.

use glam::{DMat3, DVec3};

use crate::world::{Mobility, Velocity};

/// Motion of the material points beside a particle, and their response to a force.
#[derive(Clone, Copy, Debug, Default)]
pub struct LocalMotion {
    /// Of the particle, m/s.
    pub velocity: DVec3,
    /// F' of the particle, 1/s.
    pub rate: DMat3,
    /// Of the particle, 1/kg.
    pub mobility: DVec3,
    /// The weight of the particle in the motion of the point A is 1 - c . A, 1/m: c is M^-1 times the first
    /// moment of the weights.
    pub own: DVec3,
}

impl LocalMotion {
    /// Those of a particle whose neighbours do not count.
    pub fn alone(velocity: Velocity, mobility: Mobility) -> Self {
        Self { velocity: velocity.0, mobility: mobility.0, ..Self::default() }
    }

    /// Velocity of the point `arm` beside the particle in the reference configuration, m/s.
    pub fn velocity(&self, arm: DVec3) -> DVec3 {
        self.velocity + self.rate * arm
    }

    /// Mobility of that point along each axis, 1/kg: its inverse mass for a force. The contribution of the
    /// neighbours, by the squares of their weights, is a twentieth of it, and left out.
    pub fn mobility(&self, arm: DVec3) -> DVec3 {
        let own = 1.0 - self.own.dot(arm);
        self.mobility * (own * own)
    }
}
