//! What an update changes of the internal forces.
//!
//! The motion up to an update has used the forces of the reference before it, and so does the second kick of
//! that step; those of the new reference act from the next kick on. On either side of the update the leapfrog
//! then is that of one reference, and an update takes nothing from the motion. Were the second kick one by
//! the new forces, its work would not be that of any energy.
//!
//! What has lost particles gets the new forces at once, and the difference is booked: forces between what has
//! been removed or has failed and what is left must end together.

use std::ops::Range;

use crate::parallel::for_each_block;
use crate::schedule::{Run, Shared, Step, StepError};
use crate::world::{Force, PhaseId};

/// The change, of all rows of the phase.
#[derive(Default)]
pub(super) struct ForceChange {
    /// New forces less those of the second kick, N.
    change: Vec<Force>,
    /// Whether the update of this step has left one.
    is_new: bool,
}

impl ForceChange {
    /// There is no change yet.
    pub fn forget(&mut self) {
        self.is_new = false;
    }

    /// Notes the change from `before` to `after`, N, and makes `after` the forces of the second kick: the old
    /// ones, but the new ones of the rows that are `at_once`.
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

    /// Takes the change back from the forces of the new reference, N.
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

/// The system that goes on to the new forces once the second kick is done.
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
