//! Diffusion of density (delta-SPH): removes grid-scale noise from density and pressure, and leaves smooth
//! fields unchanged.
//!
//! `drho_i/dt = 2 delta h c_0 sum_j V_j w_ij [(rho_j - rho_i) - (g_i + g_j).x_ij / 2]` over the neighbours of
//! the same body; g is the renormalised gradient of the density with `model: Antuono`, zero with `model:
//! Molteni`.

mod gradient;
mod solid;

use meshless_engine::materials::ParameterError;
use meshless_engine::pair::{Pair, PairTerm, Rates, Relative};
use meshless_engine::parallel::{Arithmetic, Number, Vector};
use meshless_engine::plugin::{BodyKind, Offer, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::world::{BodySet, Density};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use gradient::DensityGradient;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<DensityDiffusion>();
}

/// Diffuses the density of fluids, so that the noise of their pressure decays; in the list of an Eulerian
/// solid, its density.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DensityDiffusion {
    /// The diffused quantity.
    pub model: Model,
    /// Coefficient delta: 0.1 in fluids and 0.01 in Eulerian solids, if it is not given.
    pub delta: Option<f64>,
}

/// The diffused quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Model {
    /// The deviation from a linear field: water at rest under gravity does not change.
    #[default]
    Antuono,
    /// The density itself: cheaper, for flows without gravity.
    Molteni,
}

impl Plugin for DensityDiffusion {
    const NAME: &'static str = "density_diffusion";
    const REFERENCE: &'static str = "density diffusion: M. Antuono, A. Colagrossi, S. Marrone, D. Molteni, Comput. Phys. Commun. 181 (2010) 532-549; \
         D. Molteni, A. Colagrossi, Comput. Phys. Commun. 180 (2009) 861-872";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        if let Some(delta) = self.delta {
            ParameterError::require_not_negative("delta", delta)?;
        }
        if let Some(id) = sim.own_body()
            && sim.body(id).offers(Offer::Dilatation)
        {
            let delta = self.delta.unwrap_or(OF_SOLIDS);
            return if delta == 0.0 {
                Ok(())
            } else {
                solid::add(&BodySet::new([id]), self.model, delta, sim)
            };
        }
        let fluids = sim.scope_of(BodyKind::Fluid).map_err(|error| own_solid(sim).unwrap_or(error))?;
        let delta = self.delta.unwrap_or(OF_FLUIDS);
        if delta == 0.0 || fluids.is_empty() {
            return Ok(());
        }
        if self.model == Model::Antuono {
            gradient::add(fluids.clone(), sim);
        }
        for id in fluids.iter() {
            let Some(sound_speed) = sim.body(id).material.sound_speed() else { continue };
            let strength = 2.0 * delta * sound_speed;
            match self.model {
                Model::Antuono => sim.add_pair_term(BodySet::new([id]), Self::NAME, Antuono { strength }),
                Model::Molteni => sim.add_pair_term(BodySet::new([id]), Self::NAME, Molteni { strength }),
            }
        }
        Ok(())
    }
}

/// The error in the list of a solid that takes no change of its volume.
fn own_solid(sim: &SimBuilder<'_>) -> Option<SetupError> {
    let body = sim.own_body().map(|id| sim.body(id)).filter(|body| body.kind == BodyKind::Solid)?;
    let message = format!(
        "this acts on fluids and on Eulerian solids, and body `{}` has the formulation `{}`",
        body.name, body.formulation
    );
    Some(SetupError::parameter("", message, "leave it out"))
}

/// Coefficients that are usual (for solids: Mohseni-Mofidi and Bierwisch 2020).
const OF_FLUIDS: f64 = 0.1;
const OF_SOLIDS: f64 = 0.01;

/// Share of the diffusion rate that limits the step: an explicit step is stable up to one over the rate.
const LIMIT: f64 = 0.5;

/// Diffusion of the density; strength is 2 delta c_0.
struct Molteni {
    strength: f64,
}

impl PairTerm for Molteni {
    type ReadI = (Relative<Density>,);
    type ReadJ = (Relative<Density>,);
    const CHANGES_DENSITY: bool = true;
    const READS_KERNEL: bool = false;
    const READS_VELOCITY: bool = false;

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (rho_i,): (Number<A>,),
        (rho_j,): (Number<A>,),
        rates: &mut Rates<A>,
    ) {
        let rate = self.strength * pair.smoothing_length() * pair.volume_j * pair.weight;
        rates.density = rate.mul_add(rho_j - rho_i, rates.density);
        rates.damping += LIMIT * rate;
    }
}

/// Diffusion of what differs from a linear field.
struct Antuono {
    strength: f64,
}

impl PairTerm for Antuono {
    type ReadI = (Relative<Density>, DensityGradient);
    type ReadJ = (Relative<Density>, DensityGradient);
    const CHANGES_DENSITY: bool = true;
    const READS_KERNEL: bool = false;
    const READS_VELOCITY: bool = false;

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (rho_i, g_i): (Number<A>, Vector<A>),
        (rho_j, g_j): (Number<A>, Vector<A>),
        rates: &mut Rates<A>,
    ) {
        let rate = self.strength * pair.smoothing_length() * pair.volume_j * pair.weight;
        rates.density = rate.mul_add(rho_j - rho_i - 0.5 * (g_i + g_j).dot(pair.x_ij), rates.density);
        rates.damping += LIMIT * rate;
    }
}
