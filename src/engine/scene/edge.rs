//! Where the held part of a body ends.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where the part of a body that a condition holds or moves along all axes ends, if it is selected by `within`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Edge {
    /// On the surface of the stated shape: the outermost held particles stand on it, and of the bonds between what is held and what is not the
    /// held side carries no more than its share.
    #[default]
    Stated,
    /// At the outermost held particles, half a spacing inside of the stated shape: particles stay in their lattice.
    Particles,
}
