//! Symmetry planes and periods: maps, and the ghost particles that they make of real ones.
//!
//! A ghost is one more row behind the real ones in the packed rows of a formulation. It takes what neighbours read from its source in every step, through the
//! map of the symmetry. Columns, energies and outputs know nothing of ghosts, and no force is computed on them.

mod ghosts;
mod map;
mod plane;
mod repeats;

pub use ghosts::{Ghost, Ghosts};
pub use map::Map;
pub use plane::{MirrorPlane, images};
pub use repeats::{Repeat, repeats_of};
