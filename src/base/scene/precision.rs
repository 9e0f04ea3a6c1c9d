//! Floating-point precision of the sums over neighbours of fluids.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Floating-point precision of the sums over neighbours of fluids. State, density, pressure, time integration
/// and the energy balance are always in double precision, and so are solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Precision {
    /// Single precision for differences between neighbours and for the sums over them, in blocks of eight
    /// particles: faster. The error of a force is about 1e-6 of the pair forces on its particle, and that of
    /// the sum of all forces is smaller by the root of the number of particles. In water at rest the error of
    /// the acceleration is 1e-7 of gravity for each layer of particles above.
    Mixed,
    /// Double precision.
    Double,
}
