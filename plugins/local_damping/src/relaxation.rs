//! Dynamic relaxation: damping that follows the slowest oscillation that is left, until rest.
//!
//! The Rayleigh quotient of the last displacement, omega^2 = -dx.df / (m dx.dx), is a mean of the squared
//! frequencies in the motion, weighted by their share. Damping at 2 omega removes the fast modes first; the
//! remaining motion is slower, and the rate falls with it until the slowest mode is critically damped.
//! Compared with stopping the motion at each peak of kinetic energy, it needs no detection of peaks, which
//! fast oscillations trigger too early.

use meshless_engine::schedule::{AccountKind, Run, Step, StepError};
use meshless_engine::world::BodySet;

use crate::decay::{Window, damp, name_undamped, open_account};
use crate::stiffness::{LastMotion, look};
use meshless_engine::parallel::BlockSum;

/// The relaxation of a set of bodies, which share one rate.
pub struct RelaxationSystem {
    bodies: BodySet,
    window: Window,
    tolerance: f64,
    after: f64,
    stop: bool,
    /// Whether the last step has left its forces.
    looked: bool,
    /// Squared frequency that the energy of unbalanced forces is measured with, 1/s2: the last low one.
    slow: f64,
}

impl RelaxationSystem {
    pub fn new(bodies: BodySet, window: Window, tolerance: f64, after: f64, stop: bool) -> Self {
        Self { bodies, window, tolerance, after, stop, looked: false, slow: f64::INFINITY }
    }

    /// Squared frequency of the last step, 1/s2; zero where the motion meets no resistance.
    fn measure(&mut self, motion: &LastMotion, dt: f64) -> f64 {
        let squared = if motion.inertia > 0.0 { (motion.resistance / motion.inertia).max(0.0) } else { 0.0 };
        // It falls at once and rises slowly: at a turning point of the slow motion only fast ones are seen.
        if squared > 0.0 {
            let risen = self.slow * (1.0 + dt * self.slow.sqrt());
            self.slow = if self.slow.is_finite() { squared.min(risen) } else { squared };
        }
        squared
    }

    fn at_rest(&self, motion: &LastMotion, step: &Step<'_>) -> bool {
        let stored =
            step.ledger.accounts().iter().filter(|a| a.kind == AccountKind::Stored && a.name != "kinetic");
        let elastic: f64 =
            stored.map(|account| self.bodies.iter().map(|id| account.of(id)).sum::<f64>()).sum();
        let unbalanced = if motion.unbalance > 0.0 { 0.5 * motion.unbalance / self.slow } else { 0.0 };
        let moving = 0.5 * motion.twice_kinetic + unbalanced;
        moving <= self.tolerance * self.tolerance * elastic
    }
}

impl Run for RelaxationSystem {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        open_account(step);
        name_undamped(step, &self.bodies);
        let mut motion = LastMotion::default();
        for body in self.bodies.iter() {
            motion.add(&look(step, body)?);
        }
        let known = std::mem::replace(&mut self.looked, true);
        let time = self.window.share(&step.clock);
        if !known || time == 0.0 {
            return Ok(());
        }
        let omega = self.measure(&motion, step.clock.dt).sqrt();
        let factor = (-2.0 * omega * time).exp();
        for body in self.bodies.iter() {
            damp(step, body, factor)?;
        }
        if self.stop && step.clock.end() >= self.after && self.at_rest(&motion, step) {
            *step.stop = Some(format!("in static equilibrium to {:.0e}", self.tolerance));
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        let mut state = vec![u8::from(self.looked)];
        state.extend(self.slow.to_le_bytes());
        state
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let [looked, slow @ ..] = state else { return false };
        let Ok(slow) = <[u8; 8]>::try_from(slow) else { return false };
        self.looked = *looked == 1;
        self.slow = f64::from_le_bytes(slow);
        true
    }
}
