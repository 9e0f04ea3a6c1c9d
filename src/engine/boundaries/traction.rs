//! Dead tractions: force per area of the reference configuration.

use schemars::JsonSchema;
use serde::Deserialize;

use super::broken_skin;
use super::face_area::{check_area, check_is_side, loaded_area};
use super::field::VectorField;
use super::joined_side;
use super::load::{self, DeadLoad};
use super::on_rigid::{arms_of, face_part};
use super::skin_load::{self, LoadKind, LoadedSurface, skins_of};
use crate::plugin::{Plugin, Selection, SetupError, SimBuilder};
use crate::scene::{Expression, PerAxis, Select};
use crate::world::BodyId;

/// Label and account.
const LABEL: &str = "traction";

/// Loads a surface with a force per reference area that keeps its direction (a dead load). It acts on the
/// surface itself, a `face` or `surface` of a solid or a `face` of a rigid body, whose shape is known, up to
/// the border of `within`; else on the selected particles, in equal shares of the loaded area.
///
/// A load that jumps makes the body swing; for a static answer let it grow smoothly, such as
/// `"1e5*smoothstep(t/0.01)"`, over several periods of the slowest oscillation, or use `local_damping`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Traction {
    /// A face or another part of the surface, or particles.
    pub on: Select,
    /// Traction per axis \[Pa\], a function of the reference position and time; `None` is zero.
    pub value: PerAxis<Expression>,
    /// Loaded area \[m2; m in two dimensions\]. Default: that of the surface. Of particles: of a whole face
    /// of a box its area. Else the volume of the selected particles over the thickness of their layer, which
    /// is twice their mean distance from the face, or the spacing where the selection names no face: the true
    /// area of a flat face on a lattice, some percent off on an irregular packing, so state it there.
    #[serde(default)]
    pub area: Option<f64>,
}

impl Plugin for Traction {
    const NAME: &'static str = "Traction";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        check_area(self.area)?;
        let field = VectorField::new(self.value, sim)?;
        let selection = sim.select_at_start(&Select { surface: None, ..self.on.clone() }, "on")?;
        load::require_movable(&selection, sim)?;
        sim.carry(&selection, [true; 3]);
        load::warn_of_parts(Self::NAME, &self.on, &selection, sim);
        if let Some(skins) = skins_of(&self.on, &selection, sim)? {
            let make = || LoadKind::Traction(field.clone());
            let surface = LoadedSurface { select: &self.on, area: self.area };
            let skins = skin_load::apply(LABEL, make, surface, skins, sim)?;
            if self.on.surface.is_some() {
                return Ok(());
            }
            let law = |selection: &Selection, sim: &mut SimBuilder<'_>| {
                on_particles(&self.on, self.area, field.clone(), selection, sim)
            };
            return broken_skin::apply(LABEL, skins, &selection, sim, law);
        }
        if self.on.face.is_some_and(|face| field.acts_along(face.outward().0)) {
            joined_side::refuse_load(&self.on, &selection, sim)?;
        }
        let law = on_particles(&self.on, self.area, field, &selection, sim)?;
        load::apply(LABEL, law, &selection, sim, |system| system);
        Ok(())
    }
}

/// The load in equal shares on the selected particles.
fn on_particles(
    select: &Select,
    area: Option<f64>,
    field: VectorField,
    selection: &Selection,
    sim: &SimBuilder<'_>,
) -> Result<DeadLoad, SetupError> {
    if area.is_none() {
        selection.parts.iter().try_for_each(|(id, rows)| check_is_side(select, *id, rows, sim))?;
    }
    let share = |(id, rows): &(BodyId, Vec<u32>)| {
        let each = match (area, face_part(select, *id, sim)?) {
            (Some(area), _) => area / selection.len() as f64,
            (None, Some(part)) => part.area / rows.len() as f64,
            (None, None) => loaded_area(select, sim.body(*id), rows) / rows.len() as f64,
        };
        Ok(vec![each; rows.len()])
    };
    let shares = selection.parts.iter().map(share).collect::<Result<_, SetupError>>()?;
    let arms = arms_of(select, selection, sim)?;
    Ok(DeadLoad { name: Traction::NAME, field, shares, arms })
}
