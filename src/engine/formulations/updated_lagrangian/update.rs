//! When the reference of a body is updated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// When the present configuration becomes the reference.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Update {
    /// `Adaptive(change: 1.0)` in bodies whose material flows plastically or can fail, and never in elastic
    /// ones, whose neighbours stay neighbours.
    Automatic,
    /// After every so many steps.
    Every(u64),
    /// When a pair has changed its length.
    Adaptive {
        /// Change of length over the smoothing length, half of the support radius \[1\].
        change: f64,
    },
    /// Never: the reference stays that of the start.
    Never,
}

/// Change of the length of a pair, over the smoothing length, after which the reference is updated where the
/// scene does not say so: that of a pair at the edge of the support at a strain of a half. Updates at smaller
/// changes add energy and take time; they are more accurate only where metal is squeezed flat (the table in
/// docs/updated-lagrangian.md).
pub(super) const USUAL_CHANGE: f64 = 1.0;
