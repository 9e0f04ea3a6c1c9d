//! Rigid bodies that rotate at a given rate.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::rigid_part::split_rigid;
use crate::notation::quantity;
use crate::plugin::{Plugin, SetupError, SimBuilder};
use crate::rigid::{Drive, DrivenRotation, MovingFunction, checked_axis};
use crate::scene::{Expression, Select, Vec3};
use crate::schedule::{Clock, StepError};

/// Rotates rigid bodies about an axis through their centre. The angular velocity is a function of time.
///
/// A roller that is accelerated to two revolutions a second: `RotationRate(on: Select(body: "roller"), rate:
/// "4*pi*smoothstep(t/0.1)")`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "RotationRate")]
pub struct PrescribedRotation {
    /// Rigid bodies, as a whole.
    pub on: Select,
    /// Direction of the axis; z in two dimensions.
    #[serde(default = "z_axis")]
    pub axis: Vec3,
    /// Angular velocity \[rad/s\], counter-clockwise seen against the axis.
    pub rate: Expression,
}

const fn z_axis() -> Vec3 {
    Vec3::new(0.0, 0.0, 1.0)
}

impl Plugin for PrescribedRotation {
    const NAME: &'static str = "RotationRate";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select(&self.on, "on")?;
        let axis = checked_axis(self.axis.0, sim.dimension(), "axis")?;
        let (others, rigid) = split_rigid(&selection, sim)?;
        if let Some((id, _)) = others.parts.first() {
            let message = format!("body `{}` is not rigid", sim.body(*id).name);
            let help = "`Displacement` turns the particles of other bodies, about the origin by an angle a as \
                `(\"x*(cos(a) - 1) - y*sin(a)\", \"x*sin(a) + y*(cos(a) - 1)\")`";
            return Err(SetupError::parameter("on", message, help));
        }
        for body in rigid {
            let rate = Box::new(Rate(self.rate.clone()));
            sim.extend(MovingFunction { body, value: self.rate.clone(), place: DVec3::ZERO });
            sim.extend(DrivenRotation { body, by: Self::NAME, axis, rate });
        }
        Ok(())
    }
}

/// The rate in the first component.
struct Rate(Expression);

impl Drive for Rate {
    fn velocity(
        &self,
        end_of_step: bool,
        clock: &Clock,
        _: DVec3,
        reference: DVec3,
    ) -> Result<DVec3, StepError> {
        let t = if end_of_step { clock.end() } else { clock.middle() };
        let rate = self.0.eval(reference, t);
        if rate.is_finite() {
            return Ok(DVec3::new(rate, 0.0, 0.0));
        }
        let message = format!("the rate must be finite, found {rate} at {}", quantity(t, "s"));
        Err(StepError::System { system: PrescribedRotation::NAME.to_owned(), message })
    }
}
