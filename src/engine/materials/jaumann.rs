//! Hypoelastic J2 plasticity with the Jaumann rate of the Cauchy stress.
//!
//! S' = 2 mu dev(D) + Omega S - S Omega (Mohseni-Mofidi and Bierwisch 2020, eq. 14), then the radial return.
//! The step rotates the stress by the rotation that Hughes and Winget (1980, Int. J. Numer. Methods Engrg.
//! 15, 1862-1867) compute from the spin, so that rigid rotation is exact for any step, and errors are of
//! second order.

use glam::DMat3;

use super::hardening::Hardening;
use super::j2::left_cauchy_green;
use super::return_mapping::Trial;
use crate::linalg::{Eigen, Sym3, polar};

/// State of the hypoelastic law before and after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HypoelasticState {
    /// Deviator of the Cauchy stress S, Pa.
    pub deviator: Sym3,
    /// Accumulated plastic strain.
    pub plastic_strain: f64,
    /// Temperature, K: a step leaves it as it is.
    pub temperature: f64,
}

/// Hypoelastic J2 plasticity: for every formulation that knows the velocity gradient of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HypoelasticJ2 {
    /// Shear modulus mu, Pa.
    pub shear: f64,
    /// Flow stress; none for a law without plasticity.
    pub hardening: Option<Hardening>,
}

impl HypoelasticJ2 {
    /// Advances the state by a step of `dt` seconds with the velocity gradient L at its middle, 1/s. Returns
    /// the plastic work, J for each cubic metre of the current volume.
    #[inline(always)]
    pub fn advance(&self, state: &mut HypoelasticState, gradient: &DMat3, dt: f64) -> f64 {
        let before = (1.5 * state.deviator.double_dot(&state.deviator)).sqrt();
        let mut deviator = self.elastic(&state.deviator, gradient, dt);
        let mut work = 0.0;
        if let Some(hardening) = &self.hardening {
            let stress = (1.5 * deviator.double_dot(&deviator)).sqrt();
            let strength = hardening.static_stress(state.plastic_strain, state.temperature);
            if stress > strength && dt > 0.0 {
                let (shear, strain) = (self.shear, state.plastic_strain);
                let trial = Trial { stress, shear, strain, temperature: state.temperature, dt };
                let increment = trial.increment(hardening);
                let left = 1.0 - 3.0 * shear * increment / stress;
                deviator = deviator * left;
                work = increment * 0.5 * (before + stress * left);
                state.plastic_strain += increment;
            }
        }
        state.deviator = deviator;
        work
    }

    /// The deviator after a change of F at once, without plastic flow: F after it is R U times F before, and
    /// the body is stretched by U along axes that stay, and then turned by R. A step of the Jaumann rate is
    /// of second order in both together.
    pub(super) fn jump(&self, deviator: &Sym3, before: &DMat3, after: &DMat3) -> Sym3 {
        if before == after {
            return *deviator;
        }
        match polar(*after * before.inverse()) {
            Some((rotation, stretch)) => {
                let strain = Eigen::new(&stretch).map(f64::ln).deviator();
                left_cauchy_green(&rotation, &(*deviator + strain * (2.0 * self.shear)))
            }
            // An inverted particle, which ends the run.
            None => self.elastic(deviator, &velocity_gradient_step(before, after), 1.0),
        }
    }

    /// The deviator after an elastic step.
    #[inline(always)]
    pub(super) fn elastic(&self, deviator: &Sym3, gradient: &DMat3, dt: f64) -> Sym3 {
        let rate = Sym3::symmetric_part(*gradient).deviator();
        // Half of the strain before the turn and half after it: all of it on one side would be of first
        // order.
        let half = rate * (self.shear * dt);
        turn(&(*deviator + half), gradient, dt) + half
    }
}

/// Q S Q^T with Q = (I - W/2)^-1 (I + W/2), the rotation of the spin W = dt (L - L^T)/2.
#[inline(always)]
fn turn(s: &Sym3, gradient: &DMat3, dt: f64) -> Sym3 {
    let spin = (*gradient - gradient.transpose()) * (0.25 * dt);
    let rotation = (DMat3::IDENTITY - spin).inverse() * (DMat3::IDENTITY + spin);
    left_cauchy_green(&rotation, s)
}

/// Velocity gradient at the middle of a step, times its length: the change of F by the mean of F before and
/// after.
#[inline(always)]
pub fn velocity_gradient_step(before: &DMat3, after: &DMat3) -> DMat3 {
    (*after - *before) * ((*after + *before) * 0.5).inverse()
}
