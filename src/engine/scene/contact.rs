//! Two bodies that touch.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Item;

/// Two bodies that touch, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// The names of the two bodies; twice the same name is contact of a body with itself.
    pub between: (String, String),
    /// How the force follows from the approach of the surfaces.
    pub law: Item,
    /// Coulomb's coefficient of friction \[-\].
    #[serde(default)]
    pub friction: f64,
    /// Ratio of the normal velocities after and before an impact \[-\].
    #[serde(default)]
    pub restitution: f64,
}
