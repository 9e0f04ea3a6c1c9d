//! Symmetry planes and periods: maps, and the ghost particles that they create from real ones.
//!
//! A ghost is one more row behind the real ones in the packed rows of a formulation. In every step it copies
//! the values that neighbours read from its source, through the map of the symmetry. Columns, energies and
//! outputs contain no ghosts, and no force is computed on them.

mod ghosts;
mod map;
mod plane;
mod repeats;

pub use ghosts::{Ghost, Ghosts};
pub use map::Map;
pub use plane::MirrorPlane;
pub use repeats::{Repeat, maps_of, periods_of, repeats_of};
