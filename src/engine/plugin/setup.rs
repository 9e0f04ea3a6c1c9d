//! What is done once, between spawning the particles and the first step.

use super::error::SetupError;
use crate::schedule::Resources;
use crate::world::World;

/// What a set-up step sees.
pub struct Setup<'a> {
    /// Columns and bodies; columns that nobody has filled are zero.
    pub world: &'a World,
    /// What systems share.
    pub resources: &'a mut Resources,
    /// Tells the user something; repeated at the end of the run.
    pub warnings: &'a mut Vec<String>,
}

pub(super) type SetupStep = Box<dyn FnOnce(&mut Setup<'_>) -> Result<(), SetupError>>;
