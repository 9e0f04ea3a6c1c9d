//! Position of the edge of a constrained part of a body.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Position of the edge of the part of a Lagrangian body that a condition holds or moves. It matters for a
/// part selected by `within` if the condition holds all axes, for one selected by `face` if it holds any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Edge {
    /// On the surface of the selecting shape, or on the selected face. The outermost held particles are moved
    /// there, held particles behind them do not interact, and particles next to the edge carry only the
    /// fraction of their stress that corresponds to the part of their cell in front of the edge.
    #[default]
    Stated,
    /// At the outermost held particles, usually half a spacing inside the shape: particles stay in their
    /// lattice.
    Particles,
}
