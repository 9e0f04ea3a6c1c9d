//! Conduction of heat in solids of every formulation, in the present configuration.

mod conduction;
mod neighborhood;
mod start;

use std::collections::BTreeMap;

use meshless_engine::column;
use meshless_engine::materials::ParameterError;
use meshless_engine::plugin::{BodyKind, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::scene::Expression;
use meshless_engine::world::{BodyId, BodySet, Column, ColumnSet, Temperature};
use schemars::JsonSchema;
use serde::Deserialize;

use conduction::{Conductor, add_system};

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<HeatConduction>();
}

column! {
    /// Temperature at the end of the last step: a later rise comes from other sources, such as plastic work
    /// and friction.
    pub struct ConductedTemperature(f64) = "conducted_temperature", "T_n", "K";
}

/// Conducts heat within solids; no heat passes from one body to another, or out of a surface.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HeatConduction {
    /// Thermal conductivity k \[W/(m K)\] of all bodies whose material is not in `materials`.
    pub conductivity: Option<f64>,
    /// Thermal conductivity \[W/(m K)\] by the names of the scene's materials: `{"aluminium": 167.0,
    /// "acrylic": 0.19}`.
    pub materials: BTreeMap<String, f64>,
    /// Specific heat \[J/(kg K)\] of bodies whose material has none.
    pub specific_heat: Option<f64>,
    /// Temperature at the start \[K\], a function of place. Without it that of the material, or 293.15.
    pub temperature: Option<Expression>,
}

/// Temperature at the start of bodies whose material has none, K.
const ROOM: f64 = 293.15;

impl Plugin for HeatConduction {
    const NAME: &'static str = "heat_conduction";
    const REFERENCE: &'static str = "conduction of heat: P. W. Cleary, J. J. Monaghan, J. Comput. Phys. 148 (1999) 227-264; \
         pair weights of anisotropic neighbourhoods: P. Espanol, M. Revenga, Phys. Rev. E 67 (2003) 026705";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        for value in self.conductivity.iter().chain(self.materials.values()) {
            ParameterError::require_not_negative("conductivity", *value)?;
        }
        if let Some(value) = self.specific_heat {
            ParameterError::require_positive("specific_heat", value)?;
        }
        let solids = sim.scope_of(BodyKind::Solid)?;
        if let Some(name) = self.materials.keys().find(|name| !sim.scene().materials.contains_key(*name)) {
            let message = format!("the scene has no material `{name}`");
            return Err(SetupError::parameter("materials", message, "name materials as the scene does"));
        }
        let mut conductors = Vec::new();
        for id in solids.iter() {
            conductors.extend(self.conductor(id, sim)?);
        }
        if conductors.is_empty() {
            return Ok(());
        }
        let bodies = BodySet::new(conductors.iter().map(|conductor| conductor.body));
        sim.add_column_to::<Temperature>(&bodies);
        sim.add_column_to::<ConductedTemperature>(&bodies);
        start::add_system(sim, &conductors, self.temperature.as_ref());
        add_system(sim, conductors);
        Ok(())
    }
}

impl HeatConduction {
    /// Conduction data of a body; none where no conductivity is given for it.
    fn conductor(&self, id: BodyId, sim: &SimBuilder<'_>) -> Result<Option<Conductor>, SetupError> {
        let body = sim.body(id);
        let given = self.materials.get(&body.material_name).copied().or(self.conductivity);
        let Some(conductivity) = given else {
            if self.materials.is_empty() {
                let help = "metals have 15 to 400 W/(m K), plastics some 0.2";
                return Err(SetupError::parameter("", "`heat_conduction` needs a `conductivity`", help));
            }
            return Ok(None);
        };
        let law = body.solid_law()?;
        let Some(specific_heat) = law.specific_heat().or(self.specific_heat) else {
            let message =
                format!("the material `{}` of body `{}` has no specific heat", body.material_name, body.name);
            return Err(SetupError::parameter("", message, "give `specific_heat` here, or in the material"));
        };
        let mut state = ColumnSet::default();
        law.state(&mut state);
        let has_temperature = state.get(Temperature::NAME).is_some();
        Ok(Some(Conductor { body: id, conductivity, specific_heat, has_temperature }))
    }
}
