//! Hourglass control of total-Lagrangian bodies.
//!
//! The deformation gradient of a particle is a mean over its neighbourhood; motions that leave the mean as it is, the
//! zero-energy or hourglass modes, meet no resistance from stress. The control resists the error of the mean,
//! `e_ij = F_i X_ij - x_ij`.

mod cracks;
mod ganzenmueller_2015;
mod resistance;
mod variational;
mod viscous;

use std::marker::PhantomData;

use cracks::{OffCracks, add_off_cracks, can_fail};
use ganzenmueller_2015::Ganzenmueller2015;
use meshless_engine::materials::ParameterError;
use meshless_engine::plugin::{Offer, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::solids::{FoldedTerm, FoldedTermOfBodies};
use meshless_engine::world::{
    BodySet, ColumnSet, DeformationGradient, HourglassGradient, HourglassMisfit, HourglassModulus,
};
pub use resistance::AfterYield;
use resistance::Resistance;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use variational::Variational;
use viscous::Viscous;

/// Registers the plugin.
pub fn register(registry: &mut Registry) {
    registry.plugin::<HourglassControl>();
}

/// Resists hourglass modes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HourglassControl {
    /// How the error of the mean deformation is resisted.
    pub form: Form,
    /// Coefficient alpha of the elastic resistance. Default: 5 of `Variational` and `Combined`, 25 of `Ganzenmueller2015`.
    pub alpha: Option<f64>,
    /// Coefficient zeta of the viscous resistance, of `Viscous` and `Combined`.
    pub zeta: f64,
    /// Share chi of the viscous part of `Combined`, 0 to 1.
    pub chi: f64,
    /// What the elastic resistance is in particles that have yielded.
    pub after_yield: AfterYield,
}

impl Default for HourglassControl {
    fn default() -> Self {
        Self {
            form: Form::Variational,
            alpha: None,
            zeta: 10.0,
            chi: 0.5,
            after_yield: AfterYield::YieldStress,
        }
    }
}

/// Forms of the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Form {
    /// The whole error vector, with the weights of the deformation gradient: the exact gradient of an energy.
    Variational,
    /// The error along the bond (Ganzenmueller 2015, eqs. 31-32). It has no energy, and is booked as work.
    Ganzenmueller2015,
    /// A viscous force along the bond against the growth of the error (Mohseni-Mofidi and Bierwisch 2020, eq. 33).
    Viscous,
    /// chi times `Viscous` and 1 - chi times `Variational` (Ganzenmueller and others 2016; eq. 34 of the above).
    Combined,
}

impl Plugin for HourglassControl {
    const NAME: &'static str = "hourglass_control";
    const REFERENCE: &'static str = "hourglass control: G. C. Ganzenmueller, Comput. Methods Appl. Mech. Engrg. 286 (2015) 87-106, in variational form";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let bodies = sim.scope_offering(Offer::FoldedTerms)?;
        let default = if self.form == Form::Ganzenmueller2015 { 25.0 } else { 5.0 };
        let alpha = self.alpha.unwrap_or(default);
        ParameterError::require_not_negative("alpha", alpha)?;
        ParameterError::require_not_negative("zeta", self.zeta)?;
        if !(0.0..=1.0).contains(&self.chi) {
            let message = format!("`chi` is {}, outside of 0 to 1", self.chi);
            return Err(SetupError::parameter("chi", message, "it is the share of the viscous part"));
        }
        match self.form {
            Form::Variational => self.add_variational(alpha, bodies, sim),
            Form::Ganzenmueller2015 => self.add_ganzenmueller_2015(alpha, &bodies, sim),
            Form::Viscous => add_viscous(self.zeta, &bodies, sim),
            Form::Combined => {
                add_viscous(self.chi * self.zeta, &bodies, sim)?;
                self.add_variational((1.0 - self.chi) * alpha, bodies, sim)
            }
        }
    }
}

impl HourglassControl {
    fn add_variational(
        &self,
        alpha: f64,
        bodies: BodySet,
        sim: &mut SimBuilder<'_>,
    ) -> Result<(), SetupError> {
        if alpha == 0.0 {
            return Ok(());
        }
        let mut state = ColumnSet::default();
        for id in bodies.iter() {
            sim.body(id).solid_law()?.state(&mut state);
        }
        // Only a law with state can make a particle softer.
        let mut released = None;
        if state.iter().next().is_some() {
            sim.add_column_to::<HourglassModulus>(&bodies);
            sim.add_column_to::<HourglassMisfit>(&bodies);
            released = Some("hourglass_released".to_owned());
        }
        let term: Box<dyn FoldedTerm> = Box::new(Variational { alpha, after_yield: self.after_yield });
        let account = Some("hourglass".to_owned());
        FoldedTermOfBodies { account, released, term }.add(bodies, sim);
        Ok(())
    }

    fn add_ganzenmueller_2015(
        &self,
        alpha: f64,
        bodies: &BodySet,
        sim: &mut SimBuilder<'_>,
    ) -> Result<(), SetupError> {
        if alpha == 0.0 {
            return Ok(());
        }
        sim.add_column_to::<HourglassModulus>(bodies);
        let term: Box<dyn FoldedTerm> = Box::new(Resistance(self.after_yield));
        FoldedTermOfBodies { account: None, released: None, term }.add(bodies.clone(), sim);
        for id in bodies.iter() {
            let density = sim.body(id).material.density;
            if can_fail(sim, id)? {
                let term = Ganzenmueller2015::<HourglassGradient> { alpha, density, measure: PhantomData };
                add_off_cracks(sim, id, "hourglass_work", OffCracks(term));
            } else {
                let term = Ganzenmueller2015::<DeformationGradient> { alpha, density, measure: PhantomData };
                sim.add_pair_term(BodySet::new([id]), "hourglass_work", term);
            }
        }
        Ok(())
    }
}

fn add_viscous(zeta: f64, bodies: &BodySet, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    if zeta == 0.0 {
        return Ok(());
    }
    for id in bodies.iter() {
        let body = sim.body(id);
        let density = body.material.density;
        let sound_speed = (body.solid_law()?.elastic().bulk / density).sqrt();
        if can_fail(sim, id)? {
            let term = Viscous::<HourglassGradient> { zeta, sound_speed, density, measure: PhantomData };
            add_off_cracks(sim, id, "hourglass_viscosity", OffCracks(term));
        } else {
            let term = Viscous::<DeformationGradient> { zeta, sound_speed, density, measure: PhantomData };
            sim.add_pair_term(BodySet::new([id]), "hourglass_viscosity", term);
        }
    }
    Ok(())
}
