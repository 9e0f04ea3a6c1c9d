//! Initial displacement of particles.

use schemars::JsonSchema;
use serde::Deserialize;

use super::field::VectorField;
use super::part::{Part, parts_of};
use crate::notation::place;
use crate::plugin::{BodyKind, Plugin, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};
use crate::world::{BodyId, Position};

/// Starts particles away from their reference positions, which carry no stress, such as for a body that is
/// released from a stretched state. It acts once, on fixed particles too; a `Displacement` moves its
/// particles to its own places. A rigid body starts where its shape is: `Translate` and `Rotate` place it.
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
        parts.iter().try_for_each(|part| leave_rigid(part, &field, sim))?;
        sim.leave_note(DisplacedBodies(parts.iter().map(|part| part.body).collect()));
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

/// Bodies that do not start where their shapes are.
pub struct DisplacedBodies(pub Vec<BodyId>);

/// Largest displacement of a particle of a rigid body, over the spacing, that is none.
const ROUNDING: f64 = 1e-9;

/// An error where a rigid body would be displaced: its place is that of its shape, from which the first step
/// would move its particles back.
fn leave_rigid(part: &Part, field: &VectorField, sim: &SimBuilder<'_>) -> Result<(), SetupError> {
    let body = sim.body(part.body);
    if body.kind != BodyKind::Rigid {
        return Ok(());
    }
    let moved = part.points.iter().find(|&&x| field.at(x, 0.0).length() > ROUNDING * body.spacing);
    moved.map_or(Ok(()), |&moved| {
        let message = format!(
            "a rigid body starts where its shape is, and the value would move `{}` by {} m at {} m",
            body.name,
            place(field.at(moved, 0.0)),
            place(moved)
        );
        let help = "leave this body out of `on`, and place its shape by `Translate` and `Rotate`";
        Err(SetupError::parameter("on", message, help))
    })
}
