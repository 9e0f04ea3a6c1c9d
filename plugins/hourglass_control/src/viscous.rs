//! The viscous form: a pair force against the growth of the hourglass residual (Mohseni-Mofidi and Bierwisch
//! 2020, eq. 33).
//!
//! `f_i = zeta rho_0 sum_j V_i V_j (|e_ij| / |X_ij|) c h (v_ij . x_ij) / |x_ij|^2 |W'_ij| x_ij / |x_ij|`
//! where the residual `e_ij = (F_i + F_j)/2 X_ij - x_ij` grows, (v_ij . x_ij)(e_ij . x_ij) < 0. In the paper
//! the equation lacks the density, the gradient of the kernel is a vector, and the sign is that for pair
//! vectors from i to j. The force is along the bond and against the relative motion: momentum and angular
//! momentum are conserved, and the force only dissipates energy.

use std::marker::PhantomData;

use glam::DMat3;
use meshless_engine::pair::{Pair, PairTerm, Rates};
use meshless_engine::parallel::{Arithmetic, Matrix};
use meshless_engine::plugin::{SetupError, SimBuilder};
use meshless_engine::world::{BodyId, Column};

/// The viscous form for one body; `F` is the column of the deformation gradient.
pub struct Viscous<F> {
    /// zeta.
    pub zeta: f64,
    /// Speed of bulk waves c = sqrt(K / rho_0), m/s.
    pub sound_speed: f64,
    /// Density rho_0, kg/m3.
    pub density: f64,
    pub measure: PhantomData<F>,
}

impl<F> Viscous<F> {
    /// The form for the material of a body.
    ///
    /// # Errors
    /// It is not a solid.
    pub fn of(zeta: f64, id: BodyId, sim: &SimBuilder<'_>) -> Result<Self, SetupError> {
        let density = sim.body(id).material.density;
        let sound_speed = (sim.body(id).solid_law()?.elastic().bulk / density).sqrt();
        Ok(Self { zeta, sound_speed, density, measure: PhantomData })
    }
}

impl<F: Column<Value = DMat3>> PairTerm for Viscous<F> {
    type ReadI = (F,);
    type ReadJ = (F,);

    const READS_KERNEL: bool = false;
    const NEEDS_REFERENCE: bool = true;

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (f_i,): (Matrix<A>,),
        (f_j,): (Matrix<A>,),
        rates: &mut Rates<A>,
    ) {
        let error = (f_i + f_j) * pair.reference_x_ij * 0.5 - pair.x_ij;
        let moving = pair.v_ij.dot(pair.x_ij);
        let length = pair.reference_distance();
        let share = error.length_squared().sqrt() / length;
        let strength =
            self.zeta * self.sound_speed * pair.smoothing_length() * share * pair.slope() * pair.volume_j;
        let growing = moving * error.dot(pair.x_ij);
        let damping = growing.if_below(0.0, strength / pair.distance());
        rates.force +=
            pair.x_ij * (self.density * pair.volume_i * damping * moving / pair.distance_squared());
        rates.damping += damping;
    }
}
