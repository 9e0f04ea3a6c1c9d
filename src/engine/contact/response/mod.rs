//! One contact: its force from overlap and velocity, its history, its energy and its stable time step.

mod history;

mod interaction;

mod sliding;

mod spin;

pub(super) mod energy;

pub(super) mod time_step;

pub(super) use energy::{CHANGE_OF_SURFACE, ContactEnergy};
pub(super) use history::{Histories, History, PairKey};
pub(super) use interaction::{ContactState, Interaction, Losses};
pub(super) use sliding::Sliding;
pub(super) use spin::spin_of;
