//! Pressure: a load that stays normal to the deforming face.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::broken_skin;
use super::face_area::{check_area, check_is_side, loaded_area, normal_of};
use super::joined_side;
use super::load;
use super::load_law::LoadLaw;
use super::part::Part;
use super::skin_load::{self, LoadKind, LoadedSurface, skins_of};
use crate::notation::{place, quantity};
use crate::plugin::{BodyKind, Plugin, Selection, SetupError, SimBuilder};
use crate::scene::{Expression, Select};
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, DeformationGradient};

/// Label and account.
const LABEL: &str = "pressure";

/// Presses on a surface; the force follows it as it turns and stretches. It acts on the surface itself, a
/// `face` or `surface` of a solid whose shape is known, up to the border of `within`, with the current area
/// and normal; else on the particles of a face, by f = -p J F^-T N A (Nanson's formula, N and A normal and
/// area in the reference configuration), in equal shares of the loaded area.
///
/// The bore of a ring: `Pressure(on: Select(body: "ring", surface: Inner), value: 1e6)`.
///
/// A smooth start within 10 ms: `Pressure(on: Select(body: "plate", face: MaxY), value:
/// "1e5*smoothstep(t/0.01)")`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Pressure")]
pub struct PressureLoad {
    /// A face, or another part of the surface.
    pub on: Select,
    /// Pressure \[Pa\], positive towards the body, a function of the reference position and time.
    pub value: Expression,
    /// Loaded area in the reference configuration \[m2; m in two dimensions\]. Default: as for `Traction`.
    #[serde(default)]
    pub area: Option<f64>,
}

impl Plugin for PressureLoad {
    const NAME: &'static str = "Pressure";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        check_area(self.area)?;
        if self.on.surface.is_none() {
            normal_of(&self.on)?;
        }
        let selection = sim.select(&Select { surface: None, ..self.on.clone() }, "on")?;
        sim.carry(&selection, [true; 3]);
        if let Some(skins) = skins_of(&self.on, &selection, sim)? {
            let make = || LoadKind::Pressure(self.value.clone());
            let surface = LoadedSurface { select: &self.on, area: self.area };
            let skins = skin_load::apply(LABEL, make, surface, skins, sim)?;
            if self.on.surface.is_some() {
                return Ok(());
            }
            return broken_skin::apply(LABEL, skins, &selection, sim, |selection, sim| {
                self.on_particles(selection, sim)
            });
        }
        joined_side::refuse_load(&self.on, &selection, sim)?;
        let law = self.on_particles(&selection, sim)?;
        let bodies: Vec<_> = selection.parts.iter().map(|(id, _)| *id).collect();
        let is_fluid = |id: &BodyId| sim.body(*id).kind == BodyKind::Fluid;
        let fluids: Vec<BodyId> = bodies.iter().copied().filter(is_fluid).collect();
        sim.add_setup(move |setup| {
            let without = |id: &&BodyId| !setup.world.body_view(**id).0.has::<DeformationGradient>();
            match bodies.iter().find(without) {
                Some(id) => Err(SetupError::parameter(
                    format!("bodies[{}].formulation", id.0),
                    "a pressure acts on this body, which has no deformation gradient",
                    match fluids.contains(id) {
                        true => load::PRESSED_SURFACE,
                        false => "use `Traction`, or a solid formulation",
                    },
                )),
                None => Ok(()),
            }
        });
        load::apply(LABEL, law, &selection, sim, |system| system.reads::<DeformationGradient>());
        Ok(())
    }
}

impl PressureLoad {
    /// The load in equal shares on the selected particles.
    fn on_particles(&self, selection: &Selection, sim: &SimBuilder<'_>) -> Result<Follower, SetupError> {
        let normal = normal_of(&self.on)?;
        if self.area.is_none() {
            selection.parts.iter().try_for_each(|(id, rows)| check_is_side(&self.on, *id, rows, sim))?;
        }
        let areas = selection.parts.iter().map(|(id, rows)| match self.area {
            Some(area) => area / selection.len() as f64,
            None => loaded_area(&self.on, sim.body(*id), rows) / rows.len() as f64,
        });
        Ok(Follower { value: self.value.clone(), normal, areas: areas.collect() })
    }
}

struct Follower {
    value: Expression,
    /// Outward normal N in the reference configuration.
    normal: DVec3,
    /// Reference area of a particle of every part, m2.
    areas: Vec<f64>,
}

impl LoadLaw for Follower {
    fn forces(&self, k: usize, part: &Part, step: &Step<'_>, out: &mut Vec<DVec3>) -> Result<(), StepError> {
        let (view, _) = step.world.body_view(part.body);
        let gradient = view.read::<DeformationGradient>()?;
        let t = step.clock.end();
        out.clear();
        for (&row, &point) in part.rows.iter().zip(&part.points) {
            let pressure = self.value.eval(point, t);
            if !pressure.is_finite() {
                let message = format!(
                    "the pressure must be finite, found {pressure} Pa at the reference position {} m and {}",
                    place(point),
                    quantity(t, "s")
                );
                return Err(StepError::System { system: PressureLoad::NAME.to_owned(), message });
            }
            let f = gradient[row as usize].0;
            // J F^-T N, the cofactor matrix times N, from products of columns: it needs no division.
            let (a, b, c) = (f.x_axis, f.y_axis, f.z_axis);
            let area = b.cross(c) * self.normal.x + c.cross(a) * self.normal.y + a.cross(b) * self.normal.z;
            out.push(-pressure * self.areas[k] * area);
        }
        Ok(())
    }

    fn is_constant(&self, _: &Part) -> bool {
        false
    }

    fn functions(&self) -> Vec<Expression> {
        vec![self.value.clone()]
    }
}
