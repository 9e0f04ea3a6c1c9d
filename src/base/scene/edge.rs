//! Where the held part of a body ends.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where the part of a Lagrangian body that a condition holds or moves ends: along all axes if it is selected
/// by `within`, along any if by `face`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Edge {
    /// On the surface of the stated shape, or on the stated side: the outermost held particles are moved
    /// there, held particles behind them do not interact, and the particles beside the edge carry the share
    /// of their stress that their cells have in front of it.
    #[default]
    Stated,
    /// At the outermost held particles, mostly half a spacing inside: particles stay in their lattice.
    Particles,
}
