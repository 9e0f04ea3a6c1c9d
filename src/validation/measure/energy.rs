//! The energy balance of a run, and its tolerance for each kind of run.
//!
//! Every energy has an account, so that the residual is the error of the leapfrog. It is that of the square
//! of the step where bodies and flows move smoothly, and that of single steps where something begins or ends
//! within one: a touch, a yield, a bond that breaks, a reference that is renewed. The largest error of the
//! run counts, over the largest energy of an account in the run.

use meshless_engine::simulation::Simulation;

use crate::check::Check;

/// What happens in a run, as far as the energy balance is concerned.
#[derive(Clone, Copy)]
pub enum Kind {
    /// Bodies deform and swing, slide along each other or lie in a flow; flows have surfaces, waves and jets.
    Smooth,
    /// Bodies yield or break, or slip particle by particle over the edge of a tool; a lattice of fluid
    /// particles breaks up.
    Inelastic,
    /// Bodies hit each other, their references are renewed every few steps, or particles leave the run.
    Abrupt,
}

impl Kind {
    /// Largest error of the energy balance over the largest energy.
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
    /// Largest error, J.
    error: f64,
    /// Largest energy that any account has held, J.
    scale: f64,
}

impl Balance {
    /// That of a run which has not come to its end: it passes no check.
    pub const UNKNOWN: Self = Self { error: f64::NAN, scale: 1.0 };

    /// Takes notice of a step.
    pub fn see(&mut self, simulation: &Simulation) {
        let ledger = simulation.ledger();
        self.error = self.error.max(ledger.balance_error().abs());
        self.scale = ledger.largest();
    }

    /// Compares it with the tolerance of such a run.
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
