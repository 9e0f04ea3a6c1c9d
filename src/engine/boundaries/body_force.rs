//! Forces per mass.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::field::VectorField;
use super::load;
use super::load_law::LoadLaw;
use super::part::Part;
use crate::plugin::{Plugin, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};
use crate::schedule::{Step, StepError};
use crate::world::Mass;

/// Loads particles with a force per mass, a function of place and time: a shaking table, an electromagnetic
/// force. The place is the reference position of a solid or rigid body, and the present position of a fluid.
/// Constant gravity of all bodies is `gravity` of the scene. Walls beside a fluid feel it as they feel
/// gravity.
///
/// Gravity that grows within 0.1 s: `BodyForce(on: Select(), value: (0.0, "-9.81*smoothstep(t/0.1)"))`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyForce {
    /// Particles.
    pub on: Select,
    /// Force per mass along each axis \[N/kg\]; `None` is zero.
    pub value: PerAxis<Expression>,
}

impl Plugin for BodyForce {
    const NAME: &'static str = "BodyForce";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select_at_start(&self.on, "on")?;
        load::require_movable(&selection, sim)?;
        load::warn_of_parts(Self::NAME, &self.on, &selection, sim);
        let field = VectorField::new(self.value, sim)?;
        let law = ForcePerMass { field };
        load::apply("body_force", law, &selection, sim, |system| system.reads::<Mass>());
        Ok(())
    }
}

/// A field of the place and time, times the mass of every particle.
struct ForcePerMass {
    field: VectorField,
}

impl LoadLaw for ForcePerMass {
    fn forces(&self, _: usize, part: &Part, step: &Step<'_>, out: &mut Vec<DVec3>) -> Result<(), StepError> {
        self.field.values(&part.points, step.clock.end(), BodyForce::NAME, out)?;
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
}
