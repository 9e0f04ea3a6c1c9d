//! Change of the internal forces by an update of the reference.
//!
//! The second kick of the step of an update uses the forces of the old reference, as the motion before it
//! did; the forces of the new reference act from the next kick on. The leapfrog before and after the update
//! thus has one reference each, and the update does no work on the motion. With the new forces, the work of
//! the second kick would not be the change of any energy.
//!
//! Bodies that have lost particles use the new forces at once, and the difference is booked: the forces
//! between removed or failed particles and their neighbours must end together.

use std::ops::Range;

use crate::parallel::for_each_block;
use crate::schedule::{Run, Shared, Step, StepError};
use crate::world::{Force, PhaseId};

/// The change of the forces on all rows of the phase.
#[derive(Default)]
pub(super) struct ForceChange {
    /// New forces less those of the second kick, N.
    change: Vec<Force>,
    /// Whether an update of this step has written it.
    is_new: bool,
}

impl ForceChange {
    /// Discards the change: none is left to apply.
    pub fn forget(&mut self) {
        self.is_new = false;
    }

    /// Stores the change from `before` to `after`, N, and sets `after` to the forces of the second kick:
    /// those of the old reference, and of the new one in the rows `at_once`.
    pub fn note(
        &mut self,
        before: &[Force],
        after: &mut [Force],
        at_once: impl Iterator<Item = Range<usize>>,
    ) {
        self.change.clear();
        self.change.extend(after.iter().zip(before).map(|(after, before)| Force(after.0 - before.0)));
        at_once.for_each(|rows| self.change[rows].fill(Force::default()));
        after.iter_mut().zip(&self.change).for_each(|(force, change)| force.0 -= change.0);
        self.is_new = true;
    }

    /// Subtracts the change from the forces of the new reference, N.
    pub fn take_back(&self, force: &mut [Force]) {
        self.apply(force, -1.0);
    }

    fn apply(&self, force: &mut [Force], sign: f64) {
        if !self.is_new {
            return;
        }
        let change = &self.change[..];
        for_each_block(force, &mut Vec::new(), &|first, force: &mut [Force]| {
            force.iter_mut().zip(&change[first..]).for_each(|(force, change)| force.0 += change.0 * sign);
        });
    }
}

/// The system that applies the change after the second kick.
pub(super) struct ChangeForces {
    pub phase: PhaseId,
    pub change: Shared<ForceChange>,
}

impl Run for ChangeForces {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut change = step.resources.of_mut(self.change);
        if change.is_new {
            change.apply(&mut step.world.phase(self.phase).write_own::<Force>()?, 1.0);
            change.forget();
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn the_old_forces_come_first_and_the_new_ones_then_but_of_what_has_lost_something() {
        let forces = |x: [f64; 3]| x.map(|x| Force(DVec3::X * x)).to_vec();
        let (before, new) = (forces([1.0, 2.0, 3.0]), forces([1.5, 2.5, 7.0]));
        let mut change = ForceChange::default();
        let (mut used, mut afterwards) = (new.clone(), new.clone());
        change.take_back(&mut afterwards);
        assert_eq!(afterwards, new, "nothing has changed yet");
        change.note(&before, &mut used, std::iter::once(2..3));
        assert_eq!(used, forces([1.0, 2.0, 7.0]));
        change.take_back(&mut afterwards);
        assert_eq!(afterwards, used);
        change.apply(&mut afterwards, 1.0);
        assert_eq!(afterwards, new);
    }
}
