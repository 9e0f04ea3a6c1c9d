//! What is recorded, and how often.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is recorded, and how often.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Time between two frames \[s\]; without it a hundredth of the duration.
    #[serde(default)]
    pub every: Option<f64>,
    /// Fields that are recorded beside the positions, such as `"pressure"`, `"von_mises"` or `"velocity.x"`.
    #[serde(default)]
    pub fields: Vec<String>,
    /// Time between two checkpoints \[s\]; without it only an interrupted run leaves one.
    #[serde(default)]
    pub checkpoint_every: Option<f64>,
    /// Whether each frame is also written as a ParaView file.
    #[serde(default)]
    pub vtk: bool,
}
