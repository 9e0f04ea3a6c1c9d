//! The stable time step of a body whose reference configuration gives the weights.
//!
//! The largest frequency of the scheme is estimated particle by particle from sums over its bonds. Stress
//! gives `omega^2 = STRESS_FACTOR c_l^2 b_i` with `b_i = (sum_j V_j w_ij) trace(M_i^-1) / d`, which grows
//! where the support is cut by a surface; a bond stiffness k_i = s E_i gives `omega^2 = BOND_FACTOR s E_i
//! (sum_j V_j w_ij) / rho`. The two constants are upper bounds of the largest eigenvalue of the assembled
//! linear operator of free square and cubic blocks, regular and irregular, for spiky and Wendland kernels
//! with supports of 2 to 3 spacings, three particles and more across (thinner bodies: [`thin_body`]);
//! tests/stable_step.rs of the hourglass plugin compares with the largest frequency of a naive second
//! implementation.
//!
//! [`thin_body`]: super::thin_body

use serde::{Deserialize, Serialize};

/// Stress: omega^2 = `STRESS_FACTOR` c_l^2 b_i.
const STRESS_FACTOR: f64 = 1.45;
/// Bond stiffness: omega^2 = `BOND_FACTOR` s E / rho sum_j V_j w_ij.
const BOND_FACTOR: f64 = 3.0;
/// Control along pairs: omega^2 = `PAIR_FACTOR` sum_j k_ij / m_i.
const PAIR_FACTOR: f64 = 1.0;
/// Difference of second derivatives: omega^2 = `HESSIAN_FACTOR` eta^2 E / rho (h sum_j V_j w_ij)^2.
const HESSIAN_FACTOR: f64 = 3.0;
/// Share of the estimated critical step that is used.
const SAFETY: f64 = 0.65;

/// Steps between two evaluations of the stretches.
const STRETCH_INTERVAL: u64 = 10;

/// The stable step of a body.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct BodyStep {
    /// Factor by the stretches of the body.
    pub stretch_factor: f64,
    /// Whether that factor had changed by more than a hundredth when it was last evaluated.
    changes: bool,
    /// The step with that factor, s.
    pub stable: f64,
}

impl BodyStep {
    /// Whether the factor is to be evaluated in the step of this number: stretches change slowly. Damping
    /// leaves little room for a step that has become too long.
    pub fn is_stale(&self, number: u64, is_damped: bool) -> bool {
        number.is_multiple_of(STRETCH_INTERVAL) || is_damped && self.changes
    }

    /// Takes the factor of the present stretches.
    pub fn stretch(&mut self, factor: f64) {
        self.changes = (factor - self.stretch_factor).abs() > 0.01 * self.stretch_factor;
        self.stretch_factor = factor;
    }
}

impl Default for BodyStep {
    /// That of a body without stretch, before the first step.
    fn default() -> Self {
        Self { stretch_factor: 1.0, changes: false, stable: f64::INFINITY }
    }
}

/// Quantities that determine the stable step of a particle.
#[derive(Clone, Copy, Debug)]
pub struct StepEstimate {
    /// Squared speed of longitudinal waves c_l^2, m2/s2; more in a body that is too thin for the estimate.
    pub wave: f64,
    /// Sum of the stiffness factors of all bond terms times E / rho, m2/s2.
    pub bond: f64,
    /// Square of the coefficient of the stabilization by differences of second derivatives times modulus over
    /// density, m2/s2.
    pub hessian: f64,
}

impl StepEstimate {
    /// Square of the frequency that stress gives a particle, 1/s2, from the same sums as the stable step.
    pub(super) fn of_stress(&self, weight_sum: f64, mean_inverse: f64) -> f64 {
        STRESS_FACTOR * self.wave * weight_sum * mean_inverse
    }

    /// Stable step, s; `weight_sum` is sum_j V_j w_ij, `mean_inverse` is trace(M_i^-1) / d.
    pub fn stable_step(&self, weight_sum: f64, mean_inverse: f64) -> f64 {
        self.stable_step_with(weight_sum, mean_inverse, 0.0)
    }

    /// Stable step, s, where the difference of second derivatives of a particle has the weight `second`, m,
    /// over lengths squared: the sum of the sizes of its coefficients times the smoothing length.
    pub fn stable_step_with(&self, weight_sum: f64, mean_inverse: f64, second: f64) -> f64 {
        let hessian = HESSIAN_FACTOR * self.hessian * second * second;
        let stress = self.of_stress(weight_sum, mean_inverse);
        let bond = BOND_FACTOR * self.bond * weight_sum;
        // Between the larger of the two (they peak at different wave numbers) and their sum.
        let omega_squared = stress.hypot(bond).hypot(hessian);
        SAFETY * 2.0 / omega_squared.sqrt()
    }

    /// Stable step, s, where control along pairs gives a particle the stiffness `pairs` over its mass, 1/s2:
    /// the sum of those of its pairs.
    pub fn stable_step_with_pairs(&self, weight_sum: f64, mean_inverse: f64, pairs: f64) -> f64 {
        let stress = self.of_stress(weight_sum, mean_inverse);
        SAFETY * 2.0 / stress.hypot(PAIR_FACTOR * pairs).sqrt()
    }

    /// Whether the bond terms, not the waves, limit the step of an inner particle.
    pub fn bond_limited(&self) -> bool {
        BOND_FACTOR * self.bond > STRESS_FACTOR * self.wave
    }
}
