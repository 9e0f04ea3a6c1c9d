//! A quantity that is written as a function of time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Select, Vec3};

/// A quantity of a selection or at a point, written to `<name>.csv` as a function of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name of the probe and of its file.
    pub name: String,
    /// The particles that it averages over (for `Force`: sums over). Either this or `at`.
    #[serde(default)]
    pub on: Option<Select>,
    /// The point in space at which it interpolates \[m\]. Either this or `on`.
    #[serde(default)]
    pub at: Option<Vec3>,
    /// What is measured.
    pub quantity: Quantity,
    /// Time between two samples \[s\]; without it a tenth of the interval of the recording.
    #[serde(default)]
    pub every: Option<f64>,
}

/// What a probe measures.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Quantity {
    /// Displacement from the start \[m\].
    Displacement,
    /// Position \[m\].
    Position,
    /// Velocity \[m/s\].
    Velocity,
    /// Sum of the reaction forces of the conditions on the selection \[N\].
    Force,
    /// A column of the particles by name, such as `"pressure"` or `"von_mises"`; its unit is that of the column.
    Field(String),
    /// Kinetic, strain and all other energies of the selection, or of everything where none is given \[J\].
    Energy,
}
