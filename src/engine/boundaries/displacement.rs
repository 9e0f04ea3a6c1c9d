//! Particles with prescribed displacement.

use schemars::JsonSchema;
use serde::Deserialize;

use super::field::VectorField;
use super::joined_side;
use super::jumps;
use super::prescribed::{self, PrescribedKind};
use crate::plugin::{Plugin, SetupError, SimBuilder, Support};
use crate::scene::{Edge, Expression, PerAxis, Select};

/// Moves particles to their reference position plus a displacement, a function of that position and of time:
/// every step ends exactly there.
///
/// The displacement must start from zero. To 2 mm within 10 ms, at rest at both ends: `Displacement(on:
/// Select(face: MaxX), value: ("2e-3*smoothstep(t/0.01)", 0.0))`; this also holds y. A rigid body moves as a
/// whole, with the same value in all of its places; `RotationRate` rotates it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// Particles.
    pub on: Select,
    /// Displacement per axis \[m\]; `None` leaves the motion along an axis free.
    pub value: PerAxis<Expression>,
    /// Where the held part of a body ends.
    #[serde(default)]
    pub edge: Edge,
}

/// Largest displacement at the start, as a share of the spacing.
const ROUNDING: f64 = 1e-9;

impl Plugin for Displacement {
    const NAME: &'static str = "Displacement";
    const REFERENCE: &'static str = "";

    fn support(&self) -> Option<Support<'_>> {
        let axes = self.value.0.each_ref().map(Option::is_some);
        Some(Support { on: &self.on, axes, edge: self.edge })
    }

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select(&self.on, "on")?;
        let field = VectorField::new(self.value, sim)?;
        for part in super::part::parts_of(&selection, sim) {
            let body = sim.body(part.body);
            let jump = part.points.iter().map(|&point| field.at(point, 0.0));
            if let Some(jump) = jump.into_iter().find(|jump| {
                let allowed = ROUNDING * body.spacing;
                jump.to_array().iter().any(|component| component.is_nan() || component.abs() > allowed)
            }) {
                return Err(SetupError::parameter(
                    "value",
                    format!("the displacement of body `{}` must be zero at t = 0, found {jump} m", body.name),
                    "let it grow from zero, such as `\"2e-3*smoothstep(t/0.01)\"`",
                ));
            }
        }
        joined_side::warn_of_motion(Self::NAME, &field, |x, t| field.at(x, t), &selection, sim);
        jumps::warn(Self::NAME, &field, &selection, sim);
        prescribed::prescribe(Self::NAME, PrescribedKind::Displacement, field, &selection, sim)
    }
}
