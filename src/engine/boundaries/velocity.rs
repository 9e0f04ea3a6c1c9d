//! Particles with prescribed velocity.

use schemars::JsonSchema;
use serde::Deserialize;

use super::field::Field;
use super::prescribed::{self, Kind};
use crate::plugin::{Plugin, SetupError, SimBuilder, Support};
use crate::scene::{Edge, Expression, PerAxis, Select};

/// Moves particles with a velocity that is a function of their reference position and time.
///
/// A velocity that jumps sends a shock through the body. A smooth start within 1 ms, then a constant velocity of
/// -0.1 m/s: `Velocity(on: Select(body: "tool"), value: (None, "-0.1*smoothstep(t/1e-3)"))`. A push of 2 ms that ends as
/// smoothly as it starts: `"-0.1*smoothstep(t/1e-3)*(1 - smoothstep((t - 1e-3)/1e-3))"`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Velocity {
    /// Particles.
    pub on: Select,
    /// Velocity per axis \[m/s\]; `None` leaves the motion along an axis free.
    pub value: PerAxis<Expression>,
    /// Where the held part of a body ends.
    #[serde(default)]
    pub edge: Edge,
}

impl Plugin for Velocity {
    const NAME: &'static str = "Velocity";
    const REFERENCE: &'static str = "";

    fn support(&self) -> Option<Support<'_>> {
        let axes = self.value.0.each_ref().map(Option::is_some);
        Some(Support { on: &self.on, axes, edge: self.edge })
    }

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select(&self.on, "on")?;
        let field = Field::new(self.value, sim)?;
        prescribed::prescribe(Self::NAME, Kind::Velocity, field, &selection, sim)
    }
}
