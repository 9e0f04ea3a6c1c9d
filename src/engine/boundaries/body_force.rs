//! Forces per mass.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::field::VectorField;
use super::load;
use super::load_law::LoadLaw;
use super::part::Part;
use super::pulses::some_of;
use crate::plugin::{Plugin, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};
use crate::schedule::{Step, StepError};
use crate::world::{Mass, MissingColumn, Velocity};

/// Loads particles with a force per mass, a function of place and time: a shaking table, an electromagnetic
/// force. Constant gravity of all bodies is `gravity` of the scene. Walls beside a fluid feel it as they feel
/// gravity.
///
/// Gravity that grows within 0.1 s: `BodyForce(on: Select(), value: (0.0, "-9.81*smoothstep(t/0.1)"))`. What
/// a moon of the origin feels: `BodyForce(on: Select(body: "moon"), value: ("-x/(x^2+y^2)^1.5",
/// "-y/(x^2+y^2)^1.5"))`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyForce {
    /// Particles.
    pub on: Select,
    /// Force per mass along each axis \[N/kg\]; `None` is zero.
    pub value: PerAxis<Expression>,
    /// The place that x, y and z are.
    #[serde(default)]
    pub place: FieldPlace,
}

/// The place at which a function of place is evaluated.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, JsonSchema, PartialEq, Serialize)]
pub enum FieldPlace {
    /// Where the particle is: a field in space, as that of a magnet or the centrifugal force.
    #[default]
    Present,
    /// Where the particle of a solid or rigid body was at the start: a load that belongs to the material.
    /// Fluids have no such place, and are loaded where they are.
    Reference,
}

impl Plugin for BodyForce {
    const NAME: &'static str = "BodyForce";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select_at_start(&self.on, "on")?;
        load::require_movable(&selection, sim)?;
        sim.carry(&selection, [true; 3]);
        load::warn_of_parts(Self::NAME, &self.on, &selection, sim);
        let field = VectorField::new(self.value, sim)?;
        let law = ForcePerMass { field, place: self.place };
        load::apply("body_force", law, &selection, sim, |system| system.reads::<Mass>());
        Ok(())
    }
}

/// Step of a body in a field of force, over the time in which it swings by one radian: the period of the
/// leapfrog is then right to 0.04 %.
const SWING: f64 = 0.1;
/// Way of a body in a step, over its spacing: slopes are seen half a spacing ahead.
const WAY: f64 = 0.25;

/// A field of the place and time, times the mass of every particle.
struct ForcePerMass {
    field: VectorField,
    place: FieldPlace,
}

impl LoadLaw for ForcePerMass {
    fn forces(&self, _: usize, part: &Part, step: &Step<'_>, out: &mut Vec<DVec3>) -> Result<(), StepError> {
        self.field.values(part.places(), step.clock.end(), BodyForce::NAME, out)?;
        let (view, _) = step.world.body_view(part.body);
        let mass = view.read::<Mass>()?;
        out.iter_mut().zip(&part.rows).for_each(|(force, &row)| *force *= mass[row as usize].0);
        Ok(())
    }

    fn is_constant(&self, part: &Part) -> bool {
        self.field.is_constant(part)
    }

    fn functions(&self) -> Vec<Expression> {
        self.field.functions().cloned().collect()
    }

    fn is_in_space(&self) -> bool {
        self.place == FieldPlace::Present
    }

    /// From differences over a spacing, so that a step of the field does not count as an endless slope, and
    /// from the way in a step, so that no body is in the field before its slope is seen.
    fn rate(&self, part: &Part, step: &Step<'_>) -> Result<f64, MissingColumn> {
        if !(part.in_space && self.field.depends_on_place()) {
            return Ok(0.0);
        }
        let (view, _) = step.world.body_view(part.body);
        let velocity = view.read::<Velocity>()?;
        let speed = some_of(&part.rows).map(|row| velocity[row as usize].0.length()).fold(0.0, f64::max);
        let (time, spacing) = (step.clock.end(), step.world.body(part.body).spacing);
        let slope = |place: DVec3, axis: usize| {
            let way = 0.5 * spacing * DVec3::AXES[axis];
            (self.field.at(place + way, time) - self.field.at(place - way, time)).length_squared()
        };
        let square = |place: DVec3| (0..3).map(|axis| slope(place, axis)).sum::<f64>().sqrt() / spacing;
        let swing =
            some_of(part.places()).map(square).filter(|square| square.is_finite()).fold(0.0, f64::max);
        Ok((swing.sqrt() / SWING).max(speed / (WAY * spacing)))
    }
}
