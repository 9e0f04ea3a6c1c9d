//! The energy balance of a run, and its tolerance for each kind of run.
//!
//! Every energy has an account, so that the residual is the error of the leapfrog scheme. It is second order
//! in the step where bodies and flows move smoothly. Where something begins or ends within a step - contact,
//! yield, failure of a bond, an update of the reference - it is the error of single steps. The measure is the
//! maximum error over the maximum energy of an account in the run.

use meshless_engine::simulation::Simulation;

use crate::check::Check;

/// Kind of a run, which determines the tolerance of its energy balance.
#[derive(Clone, Copy)]
pub enum Kind {
    /// Bodies deform and swing, slide along each other or lie in a flow; flows have surfaces, waves and jets.
    Smooth,
    /// Bodies yield or break, or slip particle by particle over the edge of a tool; a lattice of fluid
    /// particles breaks up.
    Inelastic,
    /// Bodies collide, their references are updated every few steps, or particles leave the run.
    Abrupt,
}

impl Kind {
    /// Maximum error of the energy balance over the maximum energy.
    fn limit(self) -> f64 {
        match self {
            Self::Smooth => 1e-3,
            Self::Inelastic => 5e-3,
            Self::Abrupt => 1e-2,
        }
    }
}

/// The energy balance of a run.
#[derive(Clone, Copy, Default)]
pub struct Balance {
    /// Maximum error, J.
    error: f64,
    /// Maximum energy of any account, J.
    scale: f64,
}

impl Balance {
    /// The balance of a run that has not reached its end: it passes no check.
    pub const UNKNOWN: Self = Self { error: f64::NAN, scale: 1.0 };

    /// Updates the maxima after a step.
    pub fn see(&mut self, simulation: &Simulation) {
        let ledger = simulation.ledger();
        self.error = self.error.max(ledger.balance_error().abs());
        self.scale = ledger.largest();
    }

    /// Compares the balance with the tolerance of this kind of run.
    pub fn check(self, kind: Kind) -> Check {
        Check::below("energy balance error", self.error / self.scale, kind.limit(), "every joule is booked")
    }

    /// The same for one of several runs of a case.
    pub fn check_of(self, run: &str, kind: Kind) -> Check {
        let check = self.check(kind);
        Check { name: format!("{run}: {}", check.name), ..check }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_count_over_the_largest_energy_and_a_run_without_steps_or_end_passes_no_check() {
        let of = |error: f64| Balance { error, scale: 2.0 };
        assert!(of(1.9e-3).check(Kind::Smooth).passes() && !of(2.1e-3).check(Kind::Smooth).passes());
        assert!(!Balance::default().check(Kind::Abrupt).passes());
        assert!(!Balance::UNKNOWN.check(Kind::Abrupt).passes());
    }
}
