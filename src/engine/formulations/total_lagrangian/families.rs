//! Points of the material beside a particle: what moves with them, and what a force on them does.
//!
//! The deformation gradient of a particle is a weighted sum over its neighbours, and so is the motion of the material point at
//! X_i + A, with a short vector A of the reference configuration:
//!
//! ```text
//! v(X_i + A) = v_i + F'_i A = v_i + sum_j c_j (v_j - v_i),      c_j = V_j w_ij X_ij . M_i^-1 A
//! ```
//!
//! A force on the point acts on the particles with the same weights: then its work is that on the motion of the point, and, because the sum
//! of c_j x_ij is F_i A, its moment that of a force at x_i + F_i A. For a force that depends on F_i it is what a stress in the particle would do.

use std::cell::Ref;

use glam::DVec3;

use super::formulation::PackedRows;
use crate::schedule::Resources;
use crate::world::{Force, Mobility, Velocity};

/// The neighbourhoods of the particles of total-Lagrangian bodies in this step; other particles are alone.
pub(crate) struct Families<'a>(Option<Ref<'a, PackedRows>>);

impl<'a> Families<'a> {
    /// Those of a simulation.
    pub fn of(resources: &'a Resources) -> Self {
        Self(resources.try_get())
    }

    /// Calls `f` with the row, the signs of the axes, and the weight of all whose motion makes that of the point `arm` beside a particle.
    #[inline]
    fn each(&self, row: usize, arm: DVec3, mut f: impl FnMut(usize, DVec3, f64)) {
        let mut own = 1.0;
        if let Some(packed) = self.0.as_ref().filter(|_| arm != DVec3::ZERO) {
            let towards = packed.bonds.inverse_moment[row] * arm;
            let x = packed.sites[row].reference.xyz();
            for (j, weight) in packed.bonds.row(row) {
                let other = &packed.sites[j].reference;
                let weight = f64::from(weight) * other.0[3] * (other.xyz() - x).dot(towards);
                own -= weight;
                f(packed.images.source(j), packed.images.mirror(j).unwrap_or(DVec3::ONE), weight);
            }
        }
        f(row, DVec3::ONE, own);
    }

    /// Velocity of the point, m/s.
    pub fn velocity(&self, velocity: &[Velocity], row: usize, arm: DVec3) -> DVec3 {
        let mut sum = DVec3::ZERO;
        self.each(row, arm, |j, signs, weight| sum += signs * velocity[j].0 * weight);
        sum
    }

    /// Velocity of the point, m/s, and its mobility along each axis, 1/kg: how much a force on it speeds it up.
    pub fn motion(
        &self,
        velocity: &[Velocity],
        mobility: &[Mobility],
        row: usize,
        arm: DVec3,
    ) -> (DVec3, DVec3) {
        let mut sum = (DVec3::ZERO, DVec3::ZERO);
        self.each(row, arm, |j, signs, weight| {
            sum.0 += signs * velocity[j].0 * weight;
            sum.1 += mobility[j].0 * (weight * weight);
        });
        sum
    }

    /// Adds a force on the point, N.
    pub fn push(&self, force: &mut [Force], row: usize, arm: DVec3, push: DVec3) {
        self.each(row, arm, |j, signs, weight| force[j].0 += signs * push * weight);
    }
}
