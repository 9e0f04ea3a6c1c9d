//! Forces with a given total.

use schemars::JsonSchema;
use serde::Deserialize;

use super::field::VectorField;
use super::load::{self, DeadLoad};
use super::on_rigid::arms_of;
use crate::plugin::{BodyKind, Plugin, Selection, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};

/// Loads particles with a force of a given total, in equal shares; with a selection of one particle
/// (`nearest`) it is a point force. It keeps its direction. On a rigid body it acts at the stated point
/// itself, or on the `face` or the part of it that is `within`; on other bodies on the particles, half a
/// spacing inside.
///
/// A smooth start within 10 ms: `Force(on: Select(body: "beam", face: MaxX), value: (0.0,
/// "-100*smoothstep(t/0.01)"))`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Force")]
pub struct TotalForce {
    /// Particles.
    pub on: Select,
    /// Total force per axis \[N; N per metre of thickness in two dimensions\], a function of time; where it
    /// depends on place, every particle takes its share of the value at its reference position, in a fluid at
    /// its present one. A force that depends on where a solid or rigid body is now is a `BodyForce`, such as
    /// a spring, `"-k*x/m"`. `None` is zero.
    pub value: PerAxis<Expression>,
}

impl Plugin for TotalForce {
    const NAME: &'static str = "Force";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select_at_start(&self.on, "on")?;
        load::require_movable(&selection, sim)?;
        sim.carry(&selection, [true; 3]);
        load::warn_of_parts(Self::NAME, &self.on, &selection, sim);
        let field = VectorField::new(self.value, sim)?;
        warn_of_places(&field, &selection, sim);
        let share = 1.0 / selection.len() as f64;
        let shares = selection.parts.iter().map(|(_, rows)| vec![share; rows.len()]).collect();
        let arms = arms_of(&self.on, &selection, sim)?;
        let law = DeadLoad { name: Self::NAME, field, shares, arms };
        load::apply("force", law, &selection, sim, |system| system);
        Ok(())
    }
}

/// Warns of a force on a rigid body that depends on place: it is probably meant to follow the body.
fn warn_of_places(field: &VectorField, selection: &Selection, sim: &mut SimBuilder<'_>) {
    if !field.depends_on_place() {
        return;
    }
    let bodies = selection.parts.iter().map(|(id, _)| sim.body(*id));
    let rigid = bodies.filter(|body| body.kind == BodyKind::Rigid);
    let warnings: Vec<String> = rigid
        .map(|body| {
            format!(
                "`Force` on the rigid body `{}` depends on where its particles were at the start, however far it moves: a force that depends on where it is, as that of a spring, is a `BodyForce`, a force per mass",
                body.name
            )
        })
        .collect();
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}
