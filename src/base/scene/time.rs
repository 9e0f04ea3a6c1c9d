//! Duration of the experiment and its time step.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Duration and time step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time at which the run ends \[s\]; it starts at 0.
    pub end: f64,
    /// How the time step is chosen.
    #[serde(default)]
    pub step: StepRule,
    /// Largest number of sub-steps that solids and rigid bodies beside a fluid take in one step of the fluid;
    /// they take as many as their own stability limit requires. 1: all share one step.
    #[serde(default = "default_sub_steps")]
    pub sub_steps: u32,
    /// The run ends before `end` when a probe passes a value: the first of these that is met.
    #[serde(default)]
    pub stop_when: Vec<StopWhen>,
}

/// A value of a probe at which the run ends: at its first sample beyond the value after one that is not
/// beyond it. A run that is resumed goes on to the next passage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StopWhen {
    /// Name of the probe.
    pub probe: String,
    /// Column of the probe, such as `"x"` or `"kinetic"`; needed where it has several.
    #[serde(default)]
    pub column: Option<String>,
    /// The run ends when the value rises above this, in the unit of the probe.
    #[serde(default)]
    pub above: Option<f64>,
    /// The run ends when the value falls below this, in the unit of the probe.
    #[serde(default)]
    pub below: Option<f64>,
}

fn default_sub_steps() -> u32 {
    200
}

/// How the time step is chosen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Step")]
pub enum StepRule {
    /// The smallest of all stability limits, times a factor.
    Adaptive {
        /// Factor on the stability limit \[-\]; above 1 leaves the range in which the limits are known to be
        /// safe.
        #[serde(default = "one")]
        factor: f64,
    },
    /// The same step throughout \[s\].
    Fixed(f64),
}

impl Default for StepRule {
    fn default() -> Self {
        Self::Adaptive { factor: one() }
    }
}

fn one() -> f64 {
    1.0
}
