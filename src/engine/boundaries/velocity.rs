//! Particles with prescribed velocity.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::field::VectorField;
use super::joined_side;
use super::prescribed::{self, PrescribedKind};
use super::turning;
use crate::notation::{quantity, quantity_to};
use crate::plugin::{BodyKind, Plugin, Selection, SetupError, SimBuilder, Support};
use crate::scene::{Edge, Expression, PerAxis, Select};

/// Moves particles with a velocity that is a function of their reference position and time.
///
/// A velocity that jumps sends a shock through the body. A smooth start within 1 ms, then a constant velocity
/// of -0.1 m/s: `Velocity(on: Select(body: "tool"), value: (None, "-0.1*smoothstep(t/1e-3)"))`. A push of 2
/// ms that ends as smoothly as it starts: `"-0.1*smoothstep(t/1e-3)*(1 - smoothstep((t - 1e-3)/1e-3))"`. A
/// rigid body moves as a whole, with the same value in all of its places; `RotationRate` rotates it. A wall
/// or a part of a solid that turns needs a `Displacement`, because its particles leave their reference
/// positions.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Velocity")]
pub struct PrescribedVelocity {
    /// Particles.
    pub on: Select,
    /// Velocity per axis \[m/s\]; `None` leaves the motion along an axis free.
    pub value: PerAxis<Expression>,
    /// Where the held part of a body ends.
    #[serde(default)]
    pub edge: Edge,
}

impl Plugin for PrescribedVelocity {
    const NAME: &'static str = "Velocity";
    const REFERENCE: &'static str = "";

    fn support(&self) -> Option<Support<'_>> {
        let axes = self.value.0.each_ref().map(Option::is_some);
        Some(Support { on: &self.on, axes, edge: self.edge })
    }

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select(&self.on, "on")?;
        let field = VectorField::new(self.value, sim)?;
        warn_of_fast_motion(&field, &selection, sim);
        turning::warn(&field, &selection, sim);
        joined_side::warn_of_motion(Self::NAME, &field, |x, t| way(&field, x, t), &selection, sim);
        prescribed::prescribe(Self::NAME, PrescribedKind::Velocity, field, &selection, sim)
    }
}

/// The displacement of a particle at a time, by the rule of midpoints.
fn way(field: &VectorField, x: DVec3, t: f64) -> DVec3 {
    let step = t / f64::from(TIMES);
    (0..TIMES).map(|k| field.at(x, step * (f64::from(k) + 0.5)) * step).sum()
}

/// Largest speed of solids that is no slip of units, in speeds of sound.
pub const MAX_MACH: f64 = 10.0;
/// Times of a run at which it is looked at.
const TIMES: u32 = 64;

/// Warns of a speed that is most likely a slip of units.
fn warn_of_fast_motion(field: &VectorField, selection: &Selection, sim: &mut SimBuilder<'_>) {
    let end = sim.scene().time.end;
    let places = selection.parts.iter().filter_map(|(id, rows)| {
        let body = sim.body(*id);
        Some(body.sites[*rows.first()? as usize - body.rows.start].position)
    });
    let times = |k| end * f64::from(k) / f64::from(TIMES);
    let speeds = places.flat_map(|x| (0..=TIMES).map(move |k| field.at(x, times(k)).length()));
    let speed = speeds.filter(|speed| speed.is_finite()).fold(0.0, f64::max);
    let solids = sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid);
    let sounds = solids.filter_map(|body| Some((body.material.sound_speed()?, &body.name)));
    if let Some((sound, name)) = sounds.min_by(|a, b| a.0.total_cmp(&b.0))
        && speed > MAX_MACH * sound
    {
        let (factor, sound) = (quantity_to(speed / sound, "1", 3), quantity(sound, "m/s"));
        let speed = quantity(speed, "m/s");
        sim.warn(format!(
            "`Velocity` moves particles at up to {speed}, {factor} times the speed of sound in body `{name}` ({sound}): check its unit"
        ));
    }
}
