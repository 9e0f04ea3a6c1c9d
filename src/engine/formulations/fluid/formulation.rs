//! The fluid formulation: its parameters and columns.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::formulations::fluid::lanes::FluidKernel;
use crate::formulations::fluid::walls::{BeforeSphere, RangeShortfall};
use crate::kernels::KernelName;
use crate::notation::number;
use crate::plugin::{BodyKind, Formulation, Offer, SetupError, SimBuilder};
use crate::scene::{Dimension, Expression};
use crate::world::{BodyId, ColumnSet, Density, DensityRate, Pressure};

/// Weakly compressible fluid: density by continuity, pressure by the equation of state of its material,
/// laminar viscosity. All fluid bodies of a scene share one kernel and one support radius.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Fluid {
    /// Kernel: `wendland_c2`, `wendland_c4`, `wendland_c6` or `quintic_spline`; with others particles pair.
    pub kernel: KernelName,
    /// Support radius of the kernel over spacing; without it 3 in two dimensions and 2.6 in three with
    /// `wendland_c2`, so much wider with the others that the stable step is the same: 3.4, 3.8 and 3.3, 2.9,
    /// 3.3 and 2.9. The quintic spline allows 3.5 at most.
    pub support: Option<f64>,
    /// Pressure at the start \[Pa\], a function of place. Without it that of a fluid at rest under gravity
    /// below the surface above each particle, with the weight of fluids that lie on it.
    pub pressure: Option<Expression>,
}

impl Default for Fluid {
    fn default() -> Self {
        Self { kernel: KernelName::WendlandC2, support: None, pressure: None }
    }
}

/// A fluid body with its parameters, until all bodies are known.
pub struct FluidBody {
    pub id: BodyId,
    pub parameters: Fluid,
    /// Support radius, m.
    pub support: f64,
}

impl Formulation for Fluid {
    const NAME: &'static str = "Fluid";
    const REFERENCE: &'static str = "fluid boundaries: S. Adami, X. Y. Hu, N. A. Adams, J. Comput. Phys. 231 (2012) 7057-7075; \
         laminar viscosity: J. P. Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214-226";
    const KIND: BodyKind = BodyKind::Fluid;
    const BYTES_PER_PARTICLE: usize = 1800;
    const OFFERS: &'static [Offer] = &[Offer::PairTerms];

    fn columns(columns: &mut ColumnSet) {
        columns.add::<Density>().add::<DensityRate>().add::<Pressure>().add::<RangeShortfall>();
        columns.add::<BeforeSphere>();
    }

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        for (id, parameters) in bodies {
            let body = sim.body(id);
            body.fluid_law().map_err(|error| error.of_formulation(id))?;
            let of_c2 = if sim.dimension() == Dimension::Two { 3.0 } else { 2.6 };
            let Some(unit) = FluidKernel::new(parameters.kernel, 1.0, sim.dimension().count()) else {
                let message = format!("particles of a fluid pair with the kernel `{}`", parameters.kernel);
                let names = FluidKernel::NAMES.map(|name| format!("`{name}`")).join(", ");
                let help = format!("give one of {names}");
                return Err(SetupError::parameter("kernel", message, help).of_formulation(id));
            };
            // To a tenth of a spacing.
            let usual = (of_c2 * 5.0 / unit.smoothing_length()).round() / 10.0;
            let share = parameters.support.unwrap_or(usual);
            let (fewest, most) = (2.0, unit.largest_support());
            if !(share >= fewest && share <= most) {
                let message = format!(
                    "the support radius must be {fewest} to {most} spacings, found {}",
                    number(share)
                );
                let help = format!("{usual} spacings are usual");
                return Err(SetupError::parameter("support", message, help).of_formulation(id));
            }
            let support = share * body.spacing;
            sim.extend(FluidBody { id, parameters, support });
        }
        Ok(())
    }
}
