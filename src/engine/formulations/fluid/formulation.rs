//! The fluid formulation: its parameters and columns.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::plugin::{BodyKind, Formulation, Offer, SetupError, SimBuilder};
use crate::scene::{Dimension, Expression};
use crate::world::{BodyId, ColumnSet, Density, DensityRate, Pressure};

/// Weakly compressible fluid: density by continuity, pressure by the equation of state of its material, laminar viscosity.
/// All fluid bodies of a scene share one support radius.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Fluid {
    /// Support radius of the Wendland C2 kernel over spacing; without it 3 in two dimensions, 2.6 in three.
    pub support: Option<f64>,
    /// Pressure at the start \[Pa\], a function of place. Without it that of a fluid at rest under gravity below the surface
    /// above each particle, with the weight of fluids that lie on it.
    pub pressure: Option<Expression>,
}

/// A fluid body with its parameters, until all bodies are known.
pub(super) struct FluidBody {
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
    const OFFERS: &'static [Offer] = &[Offer::PairTerms];

    fn columns(columns: &mut ColumnSet) {
        columns.add::<Density>().add::<DensityRate>().add::<Pressure>();
    }

    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        for (id, parameters) in bodies {
            let body = sim.body(id);
            body.fluid_law().map_err(|error| error.of_formulation(id))?;
            let usual = if sim.dimension() == Dimension::Two { 3.0 } else { 2.6 };
            let share = parameters.support.unwrap_or(usual);
            let fewest = 2.0;
            if !(share >= fewest && share <= 10.0) {
                let message = format!("a support radius of {share} spacings does not work");
                let help = format!("give a support of {fewest} to 10 spacings; {usual} is usual");
                return Err(SetupError::parameter("support", message, help).of_formulation(id));
            }
            let support = share * body.spacing;
            sim.extend(FluidBody { id, parameters, support });
        }
        Ok(())
    }
}
