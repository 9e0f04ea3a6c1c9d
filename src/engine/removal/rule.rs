//! The rule that selects the particles to remove.

use crate::schedule::{Access, Step, StepError};
use crate::world::BodyId;

/// Says which particles are to be removed from the run. Plugins add one with
/// [`SimBuilder::add_removal_rule`](crate::plugin::SimBuilder::add_removal_rule).
pub trait RemovalRule: Send + 'static {
    /// Appends the rows of the body that are to go, ascending; rows that are out already may be named again.
    ///
    /// # Errors
    /// A column is missing.
    fn rows(&mut self, step: &Step<'_>, body: BodyId, out: &mut Vec<u32>) -> Result<(), StepError>;

    /// The columns that it reads, besides position and mass.
    fn access(&self) -> Vec<Access> {
        Vec::new()
    }
}
