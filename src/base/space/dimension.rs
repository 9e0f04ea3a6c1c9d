//! Spatial dimension.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The number of space dimensions of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Dimension {
    /// Plane strain in x-y: all z are zero, and forces and masses are those of a slice 1 m thick.
    Two,
    /// Three dimensions.
    Three,
}

impl Dimension {
    /// The number of dimensions, 2 or 3.
    pub const fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}
