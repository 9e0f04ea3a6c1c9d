//! The output of a run and its intervals.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Recorded quantities and intervals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Record")]
pub struct RecordDescription {
    /// Time between two frames \[s\]; without it a hundredth of the duration.
    #[serde(default)]
    pub every: Option<f64>,
    /// Fields that are recorded beside the positions, such as `"pressure"`, `"von_mises"` or `"velocity.x"`.
    #[serde(default)]
    pub fields: Vec<String>,
    /// Time between two checkpoints \[s\]; without it the run writes one at its end, or when it is
    /// interrupted.
    #[serde(default)]
    pub checkpoint_every: Option<f64>,
    /// Whether a completed run writes a checkpoint, from which `meshless resume --until` continues. An
    /// interrupted run always writes one.
    #[serde(default = "yes")]
    pub checkpoint_at_end: bool,
    /// Whether each frame is also written as ParaView files, `<scene>_<body>_<frame>.vtu`, with `<scene>.pvd`
    /// for their times.
    #[serde(default)]
    pub vtk: bool,
}

fn yes() -> bool {
    true
}

impl Default for RecordDescription {
    fn default() -> Self {
        Self { every: None, fields: Vec::new(), checkpoint_every: None, checkpoint_at_end: true, vtk: false }
    }
}
