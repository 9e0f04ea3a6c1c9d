//! Duration of the experiment and its time step.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Duration and time step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time at which the run ends \[s\]; it starts at 0.
    pub end: f64,
    /// Choice of the time step.
    #[serde(default)]
    pub step: StepRule,
    /// Maximum number of sub-steps that solids and rigid bodies take in one step of a fluid; they take as
    /// many as their own stability limit requires. 1: all share one step.
    #[serde(default = "default_sub_steps")]
    pub sub_steps: u32,
    /// Stop conditions: the run ends before `end` when the first of them is met.
    #[serde(default)]
    pub stop_when: Vec<StopWhen>,
}

/// A stop condition: the run ends at the first sample of a probe beyond a value that follows one not beyond
/// it. A resumed run continues to the next crossing.
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

/// Choice of the time step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Step")]
pub enum StepRule {
    /// The minimum of all stability limits, times a factor.
    Adaptive {
        /// Factor on the stability limit \[-\]; above 1 the step is outside the range in which the limits are
        /// known to be stable.
        #[serde(default = "one")]
        factor: f64,
    },
    /// A constant time step \[s\].
    Fixed(f64),
}

impl StepRule {
    /// Factor on stability limits; 1 where the step is constant.
    pub fn factor(&self) -> f64 {
        match *self {
            Self::Adaptive { factor } => factor,
            Self::Fixed(_) => 1.0,
        }
    }
}

impl Default for StepRule {
    fn default() -> Self {
        Self::Adaptive { factor: one() }
    }
}

fn one() -> f64 {
    1.0
}
