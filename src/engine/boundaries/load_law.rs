//! The force of a load on each of its particles.

use glam::DVec3;

use super::part::Part;
use crate::scene::Expression;
use crate::schedule::{Step, StepError};
use crate::world::MissingColumn;

/// The force of a load on every particle of a part.
pub(super) trait LoadLaw: Send + Sync + 'static {
    /// Writes the force on every particle of part `k`, N, at the end of the step.
    fn forces(&self, k: usize, part: &Part, step: &Step<'_>, out: &mut Vec<DVec3>) -> Result<(), StepError>;

    /// Whether the forces on a part are the same in every step.
    fn is_constant(&self, part: &Part) -> bool;

    /// The functions of place and time that it follows.
    fn functions(&self) -> Vec<Expression> {
        Vec::new()
    }

    /// Whether a load on solids and rigid bodies is a function of where they are, and not of where they were
    /// at the start.
    fn is_in_space(&self) -> bool {
        false
    }

    /// One over the longest step in which the load changes little along the way of the particles, 1/s; zero
    /// where it does not depend on where they are.
    ///
    /// # Errors
    /// The phase has no velocities.
    fn rate(&self, _: &Part, _: &Step<'_>) -> Result<f64, MissingColumn> {
        Ok(0.0)
    }

    /// From the particles of part `k` of a rigid body to where the forces act, in the reference
    /// configuration, m; none where they act on the particles.
    fn arms(&self, _: usize) -> &[DVec3] {
        &[]
    }
}
