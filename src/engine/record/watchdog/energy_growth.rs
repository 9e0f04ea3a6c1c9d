//! Energy growth without a source: the sign of an unstable integration, long before numbers overflow.

use serde::{Deserialize, Serialize};

use super::remedies::Remedies;
use crate::materials::Law;
use crate::plugin::BodyPlan;
use crate::schedule::{AccountKind, CommonMotion, Ledger, Step, StepError};
use crate::world::{BodyId, World};

/// Stored energy over what was there at the start or supplied since, beyond which the run is stopped.
const FACTOR: f64 = 10.0;
/// Steps in a row for which that must hold: the account of a plugin may lag behind by a step. An instability
/// can take two orders of magnitude of energy a step, so that more patience would see numbers overflow first.
const PATIENCE: u32 = 3;

/// Round-off of an energy per volume over Young's modulus.
const DIGITS: f64 = 4.0 * f64::EPSILON;

/// Compares the stored energy with all that the bodies were ever given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct EnergyGrowth {
    /// Largest energy at the start and supplied since, J; work that is given back does not count against the
    /// run.
    available: f64,
    /// Steps in a row beyond the limit.
    beyond: u32,
}

impl EnergyGrowth {
    /// Checks a step; stored energy below `resolution`, J, or below what the ledger calls round-off, is
    /// none.
    pub fn look(&mut self, step: &Step<'_>, resolution: f64, remedies: &Remedies) -> Result<(), StepError> {
        let (ledger, clock) = (&*step.ledger, step.clock);
        // Energy of a uniform motion of the whole scene feeds nothing.
        let drift = ledger.drift().map_or(0.0, CommonMotion::total);
        let stored = ledger.stored() - drift;
        self.available = self.available.max(ledger.stored_at_start() + ledger.supplied() - drift);
        let resolution = resolution.max(ledger.resolution());
        let sound = self.available <= 0.0 || stored <= (FACTOR * self.available).max(resolution);
        self.beyond = if sound { 0 } else { self.beyond + 1 };
        if self.beyond < PATIENCE {
            return Ok(());
        }
        let (account, body) = largest(ledger, step.world);
        let advice = remedies.of_debris(step).or_else(|| remedies.of_tension(step, Some(&body)));
        let advice = advice.map_or_else(String::new, |text| format!("; {text}"));
        Err(StepError::EnergyGrowth {
            stored,
            factor: FACTOR,
            available: self.available,
            account,
            body,
            step: clock.step,
            time: clock.time,
            advice,
        })
    }
}

/// Energy that a body may seem to hold by round-off, J: of a solid that of its Young's modulus over its
/// volume, to a few digits.
pub(super) fn resolution(body: &BodyPlan) -> f64 {
    match &body.material.law {
        Law::Solid(law) => law.elastic().young * body.volume() * DIGITS,
        _ => 0.0,
    }
}

/// The account and body with the most energy; of equal ones the first.
fn largest(ledger: &Ledger, world: &World) -> (String, String) {
    let mut most = f64::NEG_INFINITY;
    let mut found = (String::new(), String::new());
    for account in ledger.accounts().iter().filter(|account| account.kind == AccountKind::Stored) {
        for (k, body) in world.bodies().iter().enumerate() {
            let energy = account.of(BodyId(k)) - ledger.drift_of(account, BodyId(k));
            if energy > most {
                most = energy;
                found = (account.name.clone(), body.name.clone());
            }
        }
    }
    found
}
