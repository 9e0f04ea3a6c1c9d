//! Initial velocity of particles.

use std::collections::BTreeMap;

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::field::VectorField;
use super::part::{Part, parts_of};
use super::velocity::MAX_MACH;
use crate::notation::{place, quantity, quantity_to};
use crate::plugin::{BodyKind, Plugin, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};
use crate::world::{BodyId, Mobility, Velocity};

/// Gives particles a velocity to start with, a function of their place; it takes the place of the body's
/// `velocity`. Axes whose motion is prescribed keep the prescribed one, and walls their own: nothing would
/// stop them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialVelocity {
    /// Particles.
    pub on: Select,
    /// Velocity per axis \[m/s\]; `None` keeps what the body's `velocity` says.
    pub value: PerAxis<Expression>,
}

impl Plugin for InitialVelocity {
    const NAME: &'static str = "InitialVelocity";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select_at_start(&self.on, "on")?;
        let field = VectorField::new(self.value, sim)?;
        let all = parts_of(&selection, sim);
        let parts: Vec<Part> =
            all.into_iter().filter(|part| sim.body(part.body).kind != BodyKind::Boundary).collect();
        if parts.is_empty() {
            let message = "a wall has no initial velocity: its motion is prescribed by its `velocity`, by `Velocity` or by `Displacement`";
            return Err(SetupError::parameter(
                "on",
                message,
                "use `velocity` of the body, or a condition `Velocity`",
            ));
        }
        field.require_finite(&parts, "velocity")?;
        only_once(&parts, &field, sim)?;
        warn_of_fast_start(&field, &parts, sim);
        sim.add_setup(move |setup| {
            let axes = field.axes();
            for part in &parts {
                let (view, _) = setup.world.body_view(part.body);
                let mobility = view.read::<Mobility>().map_err(|error| SetupError::internal(&error))?;
                let mut velocity = view.write::<Velocity>().map_err(|error| SetupError::internal(&error))?;
                for (&row, &point) in part.rows.iter().zip(&part.points) {
                    let row = row as usize;
                    let value: DVec3 = field.at(point, 0.0);
                    for axis in (0..3).filter(|&axis| axes[axis] && mobility[row].0[axis] > 0.0) {
                        velocity[row].0[axis] = value[axis];
                    }
                }
            }
            Ok(())
        });
        Ok(())
    }
}

/// Warns of a speed in a solid that is most likely a slip of units.
fn warn_of_fast_start(field: &VectorField, parts: &[Part], sim: &mut SimBuilder<'_>) {
    for part in parts {
        let body = sim.body(part.body);
        let sound = body.material.sound_speed().filter(|_| body.kind == BodyKind::Solid);
        let speed = part.points.iter().map(|&point| field.at(point, 0.0).length()).fold(0.0, f64::max);
        if let Some(sound) = sound.filter(|sound| speed > MAX_MACH * sound) {
            let (name, factor) = (&body.name, quantity_to(speed / sound, "1", 3));
            let (speed, sound) = (quantity(speed, "m/s"), quantity(sound, "m/s"));
            sim.warn(format!(
                "`InitialVelocity` starts body `{name}` at up to {speed}, {factor} times the speed of sound in it ({sound}): check its unit"
            ));
        }
    }
}

/// Initial velocities of particles along the axes that have one, m/s, by their rows.
#[derive(Clone, Default)]
pub struct GivenVelocities(BTreeMap<(BodyId, u32), [Option<f64>; 3]>);

impl GivenVelocities {
    /// Those of a particle.
    pub fn of(&self, body: BodyId, row: u32) -> [Option<f64>; 3] {
        self.0.get(&(body, row)).copied().unwrap_or_default()
    }
}

/// Two initial velocities of one particle along one axis contradict each other.
fn only_once(parts: &[Part], field: &VectorField, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    let axes = field.axes();
    let mut given: GivenVelocities = sim.take_extensions().pop().unwrap_or_default();
    for part in parts {
        for (&row, &point) in part.rows.iter().zip(&part.points) {
            let taken = given.0.entry((part.body, row)).or_default();
            let value = field.at(point, 0.0);
            for axis in (0..3).filter(|&axis| axes[axis]) {
                if taken[axis].replace(value[axis]).is_some() {
                    let body = sim.body(part.body);
                    let number = row as usize - body.rows.start;
                    let message = format!(
                        "particle {number} of body `{}` at {} has two initial velocities along {}",
                        body.name,
                        place(body.sites[number].position),
                        ["x", "y", "z"][axis]
                    );
                    let help = "the selections must not overlap, or leave the axis to one of them";
                    return Err(SetupError::parameter("on", message, help));
                }
            }
        }
    }
    sim.leave_note(given);
    Ok(())
}
