//! Failure of solids: the criterion, the growth of damage, and the behaviour of failed particles. It wraps
//! any material law.

mod criterion;
mod energy;
mod exposure;
mod johnson_cook;
mod law;
mod removal;
mod softening;
#[cfg(test)]
mod tests;

pub use criterion::Criterion;
pub use johnson_cook::JohnsonCookFailure;
pub use softening::AfterFailure;

use criterion::WatchedCriterion;
use law::FailingLaw;
use meshless_engine::column;
use meshless_engine::materials::ParameterError;
use meshless_engine::plugin::{BodyKind, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::world::{BodyId, Column, ColumnSet, Temperature};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<Failure>();
}

column! {
    /// Failure index of a particle: 1 where its criterion is or was met.
    pub struct FailureIndex(f64) = "failure_index", "w", "1";
    /// Energy set free by damage since the start, per reference volume.
    pub struct FractureEnergy(f64) = "fracture_energy", "w_f", "J/m^3";
    /// Stored energy of a damaged particle, per reference volume.
    pub struct DamagedEnergy(f64) = "damaged_energy", "psi_D", "J/m^3";
    /// Deformation gradient at the end of the last step; of a failed particle that at failure.
    pub struct DamagedDeformation(glam::DMat3) = "damaged_deformation", "F_D", "1";
    /// Whether a failed particle has been at a surface of its body at the end of the last step: 1 or 0.
    pub struct Exposed(u32) = "exposed", "-", "1";
    /// Volume ratio of a failed particle at the end of the last step; infinite for one that has lost its
    /// integrity.
    pub struct FailedVolume(f64) = "failed_volume", "J_D", "1";
    /// Mean stress of a failed particle at the end of the last step.
    pub struct FailedStress(f64) = "failed_stress", "sigma_m", "Pa";
}

/// Lets particles of solids fail.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Failure {
    /// When a particle begins to fail.
    pub criterion: Criterion,
    /// Growth of damage from there on.
    #[serde(default)]
    pub growth: Growth,
    /// Behaviour of a particle whose damage has reached 1.
    #[serde(default)]
    pub then: AfterFailure,
}

/// Growth of damage where the criterion is met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Growth {
    /// From 0 to 1 within one step.
    #[default]
    AtOnce,
    /// The cube root of the damage grows by factor c / h per second: a crack crosses the support h (the mean
    /// of the body) at the speed factor c, c being the speed of longitudinal waves.
    CrackSpeed {
        /// Speed of the crack over the speed of waves.
        #[serde(default = "usual_speed")]
        factor: f64,
    },
}

fn usual_speed() -> f64 {
    0.4
}

/// Support of a particle in spacings, of bodies that are not total-Lagrangian.
const SUPPORT: f64 = 2.41;

impl Plugin for Failure {
    const NAME: &'static str = "failure";
    const REFERENCE: &'static str = "damage: G. C. Ganzenmueller, Comput. Methods Appl. Mech. Engrg. 286 (2015) 87-106, section 4.6; \
        failure strain: G. R. Johnson, W. H. Cook, Eng. Fract. Mech. 21 (1985) 31-48";

    const CHANGES_MATERIALS: bool = true;

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        self.criterion.check()?;
        if let Growth::CrackSpeed { factor } = self.growth {
            ParameterError::require_positive("growth.factor", factor)?;
        }
        let solid = |id: &BodyId| sim.body(*id).solid_law().is_ok();
        let bodies: Vec<BodyId> = sim.scope_of(BodyKind::Solid)?.iter().filter(solid).collect();
        for &id in &bodies {
            let body = sim.body(id);
            let speed = body.material.sound_speed().unwrap_or_default();
            let growth = match self.growth {
                Growth::AtOnce => f64::INFINITY,
                Growth::CrackSpeed { factor } => {
                    factor * speed / body.support.unwrap_or(SUPPORT * body.spacing)
                }
            };
            let (name, criterion, then) = (body.name.clone(), self.criterion.clone(), self.then);
            if criterion.needs_temperature() && !has_temperature(sim, id)? {
                sim.warn(format!(
                    "`d5` of the failure strain has no effect in body `{name}`, whose material has no temperature: give the material \
                     `heating`, or leave `d5` out"
                ));
            }
            sim.wrap_solid_law(id, |inner| {
                Ok(FailingLaw::new(WatchedCriterion::new(criterion, &*inner, &name)?, inner, growth, then))
            })?;
        }
        match self.then {
            AfterFailure::Removed => sim.add_removal_rule(removal::Failed { bodies: bodies.clone() }),
            AfterFailure::RemovedAtSurface => exposure::add(sim, &bodies),
            AfterFailure::NoTension | AfterFailure::NoDeviator => {}
        }
        energy::add_system(sim, bodies);
        Ok(())
    }
}

/// Whether the material of a body has a temperature.
fn has_temperature(sim: &SimBuilder<'_>, id: BodyId) -> Result<bool, SetupError> {
    let mut state = ColumnSet::default();
    sim.body(id).solid_law()?.state(&mut state);
    Ok(state.get(Temperature::NAME).is_some())
}
