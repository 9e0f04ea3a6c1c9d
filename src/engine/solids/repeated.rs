//! Changes by a pass that is repeated at the same positions: after an update of the reference, or a cut.

use super::bodies::SolidBodies;
use super::constitutive::SolidSum;
use crate::parallel::sum_over_blocks;
use crate::removal::LeavingParticles;
use crate::schedule::{AccountId, Step, StepError};
use crate::world::{Force, Velocity};

impl SolidBodies {
    /// Stored energy of each body in the last pass, J.
    pub fn stored(&self) -> Vec<f64> {
        self.found().iter().map(SolidSum::stored).collect()
    }

    /// Books what the bodies hold after a pass that was repeated at the same places. Terms that lose the fit
    /// or the modulus that they had say that they have released energy: that is part of the change of what is
    /// stored, which [`book_change`](Self::book_change) books.
    ///
    /// # Errors
    /// A particle is inside out.
    pub fn book_repeated(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        self.forget_released();
        self.book(step)
    }

    /// Books what a pass that was repeated at the same places has changed: the stored energies since they
    /// were `held`, J, and what the second kick of the step, by the forces `after` it, takes from a motion
    /// that those `before` it have made up to here; particles that have been removed in this step lose what
    /// the old ones would have made. Forces are those of the phase.
    ///
    /// # Errors
    /// The phase has no velocities.
    pub fn book_change(
        &self,
        step: &mut Step<'_>,
        account: AccountId,
        held: &[f64],
        before: &[Force],
        after: &[Force],
    ) -> Result<(), StepError> {
        for ((body, held), sum) in self.iter().zip(held).zip(self.found()) {
            let (view, rows) = step.world.body_view(body.id);
            let velocity = view.read::<Velocity>()?;
            let leaving = step.resources.try_get_of::<LeavingParticles>(step.world.body(body.id).phase);
            let gone = leaving.map_or(0.0, |leaving| leaving.power(&rows, before));
            let own = (&before[rows.clone()], &after[rows.clone()], &velocity[rows]);
            type Rows<'a> = (&'a [Force], &'a [Force], &'a [Velocity]);
            let left = sum_over_blocks(own, &|_, (before, after, velocity): Rows<'_>| {
                let pairs = before.iter().zip(after).zip(velocity);
                pairs.map(|((before, after), v)| (before.0 - after.0).dot(v.0)).sum::<f64>()
            });
            step.ledger.add(account, body.id, held - sum.stored() + 0.5 * step.clock.dt * (left + gone));
        }
        Ok(())
    }
}
