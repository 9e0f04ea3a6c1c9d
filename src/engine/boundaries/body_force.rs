//! Forces per mass.

use schemars::JsonSchema;
use serde::Deserialize;

use super::field::Field;
use super::load::{self, DeadLoad};
use crate::plugin::{Plugin, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};

/// Loads particles with a force per mass, a function of their reference position and time: a shaking table, an
/// electromagnetic force. Constant gravity of all bodies is `gravity` of the scene.
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
        let selection = sim.select(&self.on, "on")?;
        let field = Field::new(self.value, sim)?;
        let masses = |(id, rows): &(crate::world::BodyId, Vec<u32>)| {
            let body = sim.body(*id);
            let mass = |&row: &u32| body.material.density * body.sites[row as usize - body.rows.start].volume;
            rows.iter().map(mass).collect()
        };
        let shares = selection.parts.iter().map(masses).collect();
        let law = DeadLoad { name: Self::NAME, field, shares };
        load::apply("body_force", law, &selection, sim, |system| system);
        Ok(())
    }
}
