//! Dead tractions: force per area of the reference configuration.

use schemars::JsonSchema;
use serde::Deserialize;

use super::face_area::{check_area, check_is_side, loaded_area};
use super::field::Field;
use super::load::{self, DeadLoad};
use crate::plugin::{Plugin, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};

/// Loads particles with a force per reference area that keeps its direction (a dead load). The particles of a body carry
/// equal shares of its loaded area.
///
/// A load that jumps makes the body swing; for a static answer let it grow smoothly, such as `"1e5*smoothstep(t/0.01)"`,
/// over several periods of the slowest oscillation, or use `local_damping`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Traction {
    /// Particles, usually those of a face.
    pub on: Select,
    /// Traction per axis \[Pa\], a function of the reference position and time; `None` is zero.
    pub value: PerAxis<Expression>,
    /// Loaded area \[m2; m in two dimensions\]. Default: of a whole face of a box its area. Else the volume of the selected
    /// particles over the thickness of their layer, which is twice their mean distance from the face, or the spacing where
    /// the selection names no face: the true area of a flat face on a lattice, some percent off on an irregular packing, so
    /// state it there.
    #[serde(default)]
    pub area: Option<f64>,
}

impl Plugin for Traction {
    const NAME: &'static str = "Traction";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select(&self.on, "on")?;
        let field = Field::new(self.value, sim)?;
        check_area(self.area)?;
        if self.area.is_none() {
            selection.parts.iter().try_for_each(|(id, rows)| check_is_side(&self.on, *id, rows, sim))?;
        }
        let share = |(id, rows): &(crate::world::BodyId, Vec<u32>)| match self.area {
            Some(area) => vec![area / selection.len() as f64; rows.len()],
            None => vec![loaded_area(&self.on, sim.body(*id), rows) / rows.len() as f64; rows.len()],
        };
        let shares = selection.parts.iter().map(share).collect();
        let law = DeadLoad { name: Self::NAME, field, shares };
        load::apply("traction", law, &selection, sim, |system| system);
        Ok(())
    }
}
