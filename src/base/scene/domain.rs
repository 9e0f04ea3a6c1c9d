//! The computational domain and the conditions at its sides.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Vec3;

/// The computational domain, an axis-aligned box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Corner with the smallest coordinates \[m\].
    pub min: Vec3,
    /// Corner with the largest coordinates \[m\].
    pub max: Vec3,
    /// Axes along which the domain is periodic; a particle that leaves on one side enters on the other.
    #[serde(default)]
    pub periodic: Vec<Axis>,
    /// Treatment of a particle that leaves along an axis that is not periodic.
    #[serde(default)]
    pub outside: Outside,
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis.
    Z,
}

impl Axis {
    /// The index of the axis in a vector: 0, 1 or 2.
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// Treatment of a particle that leaves the domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Outside {
    /// The run stops and names the particle.
    #[default]
    Error,
    /// The particle is removed: it no longer moves or interacts, it is absent from recordings, and the
    /// summary counts it. Its energy is booked in the account `removed`. A rigid body is removed as a whole,
    /// once all of its particles are outside.
    Remove,
}
