//! Initial displacement of particles.

use schemars::JsonSchema;
use serde::Deserialize;

use super::field::VectorField;
use super::part::parts_of;
use crate::plugin::{Plugin, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};
use crate::world::Position;

/// Starts particles away from their reference positions, which carry no stress, such as for a body that is
/// released from a stretched state. It acts once, on fixed particles too; a `Displacement` moves its
/// particles to its own places.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialDisplacement {
    /// Particles.
    pub on: Select,
    /// Displacement per axis \[m\], a function of the reference position; `None` is zero.
    pub value: PerAxis<Expression>,
}

impl Plugin for InitialDisplacement {
    const NAME: &'static str = "InitialDisplacement";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select_at_start(&self.on, "on")?;
        let field = VectorField::new(self.value, sim)?;
        let parts = parts_of(&selection, sim);
        field.require_finite(&parts, "displacement")?;
        sim.add_setup(move |setup| {
            for part in &parts {
                let (view, _) = setup.world.body_view(part.body);
                let mut position = view.write::<Position>().map_err(|error| SetupError::internal(&error))?;
                for (&row, &point) in part.rows.iter().zip(&part.points) {
                    position[row as usize].0 += field.at(point, 0.0);
                }
            }
            Ok(())
        });
        Ok(())
    }
}
