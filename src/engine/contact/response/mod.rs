//! One contact: its force from overlap and velocity, what it remembers of the last step, its energy and the
//! time step that it allows.

mod history;

mod interaction;

pub(super) mod energy;

pub(super) mod time_step;

pub(super) use energy::{CHANGE_OF_SURFACE, ContactEnergy};
pub(super) use history::{Histories, History, PairKey};
pub(super) use interaction::{ContactState, Interaction, Losses};
