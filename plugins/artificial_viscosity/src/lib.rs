//! Artificial viscosity: dissipation at shocks and impacts, which the scheme itself does not have.
//!
//! For pairs that approach, `mu = h v_ij.x_ij / (|x_ij|^2 + 0.01 h^2) < 0` and `f_i = V_i V_j rho_0 (alpha c
//! mu - beta mu^2) |W'_ij| x_ij / |x_ij|`: a repulsion, linear and quadratic in the speed of approach. h is
//! half the support radius, c the speed of longitudinal waves, or of sound in a fluid. In fluids the linear
//! part also acts on receding pairs (Sun et al., Comput. Methods Appl. Mech. Engrg. 315 (2017) 25-49).

use meshless_engine::materials::ParameterError;
use meshless_engine::notation::quantity;
use meshless_engine::pair::{Pair, PairTerm, Rates};
use meshless_engine::parallel::Arithmetic;
use meshless_engine::plugin::{BodyKind, Offer, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::scene::Dimension;
use meshless_engine::world::{BodyId, BodySet};
use schemars::JsonSchema;
use serde::Deserialize;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<ArtificialViscosity>();
}

/// Damps the approach of particles, as shocks and impacts need it.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ArtificialViscosity {
    /// Coefficient alpha of the part that is linear in the speed of approach.
    pub alpha: f64,
    /// Coefficient beta of the quadratic part.
    pub beta: f64,
}

impl Default for ArtificialViscosity {
    fn default() -> Self {
        Self { alpha: 1.0, beta: 1.0 }
    }
}

impl Plugin for ArtificialViscosity {
    const NAME: &'static str = "artificial_viscosity";
    const REFERENCE: &'static str =
        "artificial viscosity: J. J. Monaghan, R. A. Gingold, J. Comput. Phys. 52 (1983) 374-389";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        ParameterError::require_not_negative("alpha", self.alpha)?;
        ParameterError::require_not_negative("beta", self.beta)?;
        if self.alpha == 0.0 && self.beta == 0.0 {
            return Ok(());
        }
        for id in sim.scope_offering(Offer::PairTerms)?.iter() {
            let Some(sound_speed) = sim.body(id).material.sound_speed() else { continue };
            let parting = sim.body(id).kind == BodyKind::Fluid;
            if parting {
                self.warn_of_low_reynolds(id, sim);
            }
            let material = &sim.body(id).material;
            let term = ViscousTerm {
                alpha: self.alpha,
                beta: self.beta,
                density: material.density,
                sound_speed,
                parting,
            };
            sim.add_pair_term(BodySet::new([id]), Self::NAME, term);
        }
        Ok(())
    }
}

/// Reynolds number of the artificial viscosity below which it dominates the flow.
const MIN_REYNOLDS: f64 = 50.0;

impl ArtificialViscosity {
    /// Warns where the viscosity is too large for a flow of a tenth of the speed of sound, which this is
    /// chosen for, over the smallest extent of the body: `nu = alpha h c_0 / 8`, in three dimensions over 10.
    fn warn_of_low_reynolds(self, id: BodyId, sim: &mut SimBuilder<'_>) {
        let body = sim.body(id);
        let (share, h, axes) = if sim.dimension() == Dimension::Two { (8.0, 1.5, 2) } else { (10.0, 1.3, 3) };
        let length = body.bounds.extent().to_array()[..axes].iter().copied().fold(f64::INFINITY, f64::min);
        let reynolds = 0.1 * length * share / (self.alpha * h * body.spacing);
        if reynolds < MIN_REYNOLDS {
            let text = format!(
                "`artificial_viscosity(alpha: {})` dominates the flow of `{}`: beside it a flow with a tenth of the speed of sound has a \
                 Reynolds number of {reynolds:.0} over the {} of the body; `alpha: 0.02, beta: 0.0` is usual for fluids",
                self.alpha,
                body.name,
                quantity(length, "m")
            );
            sim.warn(text);
        }
    }
}

/// Speed of approach over that of waves below which a pair does not shorten the step. Between particles that
/// rest or fly together its sign is that of rounding, and the step would be as well.
const QUIET: f64 = 1e-9;

/// The pair force within one body.
struct ViscousTerm {
    /// Whether pairs that part feel it too.
    parting: bool,
    alpha: f64,
    beta: f64,
    density: f64,
    sound_speed: f64,
}

impl PairTerm for ViscousTerm {
    type ReadI = ();
    type ReadJ = ();

    const READS_KERNEL: bool = false;
    const HEATS: bool = true;

    #[inline(always)]
    fn pair<A: Arithmetic>(&self, pair: &Pair<A>, (): (), (): (), rates: &mut Rates<A>) {
        let h = pair.smoothing_length();
        let approach = pair.v_ij.dot(pair.x_ij);
        let square = pair.distance_squared();
        let per_length = h / (square + 0.01 * h * h);
        let mu = approach * per_length;
        let push = mu.min(0.0);
        let mu = if self.parting { mu } else { push };
        let slope = pair.volume_j * pair.slope_per_length();
        let linear = self.alpha * self.sound_speed;
        let pressure = mu * linear - self.beta * push * push;
        let force = slope * pressure * (pair.volume_i * self.density);
        rates.force = pair.x_ij.mul_add(force, rates.force);
        // Half of -f_ij . v_ji: mu has the sign of the approach.
        rates.heat += 0.5 * force * approach;
        // The force per mass and speed of approach: d(f/m)/d(v_ij) along the bond.
        let damping = slope * (linear - 2.0 * self.beta * push) * (square * per_length);
        let quiet = -QUIET * self.sound_speed;
        rates.damping += if self.parting { damping } else { push.if_below(quiet, damping) };
    }
}
