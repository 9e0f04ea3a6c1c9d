//! Work done once, between spawning the particles and the first step.

use super::error::SetupError;
use crate::schedule::Resources;
use crate::world::{BodySet, World};

/// What a set-up step sees.
pub struct Setup<'a> {
    /// Columns and bodies; columns that nobody has filled are zero.
    pub world: &'a World,
    /// What systems share.
    pub resources: &'a mut Resources,
    /// Bodies whose particles a selection holds by their rows (see
    /// [`SimBuilder::select`](super::SimBuilder::select)): their rows keep their order.
    pub held: &'a BodySet,
    /// Tells the user something; repeated at the end of the run.
    pub warnings: &'a mut Vec<String>,
}

pub(crate) type SetupStep = Box<dyn FnOnce(&mut Setup<'_>) -> Result<(), SetupError>>;
