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
    /// Sum over the selection of all forces on its particles except that of what holds them \[N\]: where a condition
    /// holds or drives the selection, the force that the body exerts on the condition. A body that hangs from its
    /// support by its weight pulls it down.
    Force,
    /// Torque of the same forces about the centre of mass of the selection \[N m\].
    Torque,
    /// A field of the particles by name, such as `"pressure"`, `"velocity.x"` or `"stress.xy"`.
    Field(String),
    /// Kinetic, strain and all other energies of the selected bodies, or of everything where none is given \[J\].
    Energy,
}
