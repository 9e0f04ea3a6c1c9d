//! How precisely neighbours of a flow are summed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Arithmetic of the sums over neighbours of fluids. State, density, pressure, time stepping and the energy
/// balance are in double precision in any case, and so are solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Precision {
    /// Single precision for differences between neighbours and the sums over them, in blocks of eight
    /// particles: faster. A force has an error of some 1e-6 of the pair forces on its particle, the sum of
    /// all forces this error over the root of the number of particles, water at rest accelerations of 1e-7 of
    /// gravity for each layer of particles above.
    Mixed,
    /// Double precision.
    Double,
}
