//! Work done once, between spawning the particles and the first step.

use super::error::SetupError;
use crate::scene::Item;
use crate::schedule::Resources;
use crate::world::{BodySet, World};

/// Interface of a set-up step.
pub struct Setup<'a> {
    /// Columns and bodies; columns that nobody has filled are zero.
    pub world: &'a World,
    /// Shared data of systems.
    pub resources: &'a mut Resources,
    /// Bodies whose particles a selection holds by their rows (see
    /// [`SimBuilder::select`](super::SimBuilder::select)): their rows keep their order.
    pub held: &'a BodySet,
    /// Tells the user something; repeated at the end of the run.
    pub warnings: &'a mut Vec<String>,
}

/// A step of it, with the item of the scene that has added it, for errors.
pub(crate) type SetupStep = (Option<Item>, Box<dyn FnOnce(&mut Setup<'_>) -> Result<(), SetupError>>);
