//! Hourglass control of solids.
//!
//! The deformation gradient of a particle is a mean over its neighbourhood; motions that do not change the
//! mean, the zero-energy or hourglass modes, cause no stress. The control resists the hourglass residual,
//! `e_ij = F_i X_ij - x_ij`.

mod cracks;
mod eulerian;
mod ganzenmueller_2015;
mod resistance;
mod stiffness;
mod variational;
mod viscous;

use std::marker::PhantomData;

use cracks::{OnIntactBonds, add_off_cracks, can_fail};
use eulerian::Elastic;
use ganzenmueller_2015::Ganzenmueller2015;
use meshless_engine::materials::ParameterError;
use meshless_engine::plugin::{BodyKind, Distances, Offer, Plugin, Registry, SetupError, SimBuilder};
use meshless_engine::solids::{FoldedTerm, FoldedTermOfBodies};
use meshless_engine::world::{
    BodyId, BodySet, ColumnSet, DeformationGradient, HourglassGradient, HourglassModulus, HourglassResidual,
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
    /// Form of the resistance to the hourglass residual.
    pub form: Form,
    /// Coefficient alpha of the elastic resistance of `Variational`, `Combined` and `Ganzenmueller2015` in
    /// Lagrangian bodies. Default: 5, 25 of the last.
    pub alpha: Option<f64>,
    /// Coefficient xi of the elastic resistance in Eulerian bodies. Default: 7 of `Variational`, 10 of
    /// `Stiffness`, and 20 of `Combined` and `MohseniMofidi2020`.
    pub xi: Option<f64>,
    /// Coefficient zeta of the viscous resistance, of `Viscous`, `Combined` and `MohseniMofidi2020`.
    /// Default: 10.
    pub zeta: Option<f64>,
    /// Share chi of the viscous part of `Combined` and `MohseniMofidi2020`, 0 to 1. Default: 0.5.
    pub chi: Option<f64>,
    /// Modulus of the elastic resistance in particles that have yielded.
    pub after_yield: AfterYield,
}

impl Default for HourglassControl {
    fn default() -> Self {
        Self {
            form: Form::Default,
            alpha: None,
            xi: None,
            zeta: None,
            chi: None,
            after_yield: AfterYield::YieldStress,
        }
    }
}

/// Forms of the control.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum Form {
    /// `Variational`; `Combined` in Eulerian bodies whose material flows plastically and whose supports are
    /// spheres.
    Default,
    /// The exact gradient of an energy: of the whole residual vector, with the weights of the deformation
    /// gradient, in Lagrangian bodies; of the residual along the bond and a tenth of that across it, with the
    /// kernel at the current positions, in Eulerian ones.
    Variational,
    /// The residual along the bond (Ganzenmueller 2015, eqs. 31-32). It has no energy, and is booked as work.
    /// For Lagrangian bodies.
    Ganzenmueller2015,
    /// The residual along the bond, with the kernel at the current positions (Mohseni-Mofidi and Bierwisch
    /// 2020, eq. 32). It has no energy, and is booked as work. For Eulerian bodies.
    Stiffness,
    /// A viscous force along the bond against the growth of the residual (Mohseni-Mofidi and Bierwisch 2020,
    /// eq. 33).
    Viscous,
    /// chi times `Viscous` and 1 - chi times `Variational` (Ganzenmueller and others 2016).
    Combined,
    /// chi times `Viscous` and 1 - chi times `Stiffness` (Mohseni-Mofidi and Bierwisch 2020, eq. 34). Of
    /// Eulerian bodies.
    MohseniMofidi2020,
}

impl Form {
    /// Whether it has an elastic and a viscous part.
    fn is_mixed(self) -> bool {
        matches!(self, Self::Combined | Self::MohseniMofidi2020)
    }
}

/// Account of the work of the forms without an energy.
const WORK: &str = "hourglass_work";
/// Account of the energy dissipated by the viscous form.
const VISCOSITY: &str = "hourglass_viscosity";
/// Resistance of `Variational` to the error across a pair, over that to the error along it. Where a body is
/// twisted the errors of all pairs are across them, and bending has a part of them: without it a square bar
/// of 8 particles across is twisted by 11 % too small a torque, and a plate of 8 bends by 5 % too much. It
/// goes with the lesser E_i of the pair over Young's modulus: in metal that flows, neighbours slide past each
/// other, which is no error of theirs.
const ACROSS: f64 = 0.1;
/// Coefficient zeta and share chi where the scene gives none.
const USUAL_ZETA: f64 = 10.0;
const USUAL_CHI: f64 = 0.5;
/// Coefficient xi where the scene gives none: of `Variational` alone, and of all other forms, before the
/// share of the viscous part is taken off.
const USUAL_XI: [f64; 2] = [7.0, 10.0];

impl Plugin for HourglassControl {
    const NAME: &'static str = "hourglass_control";
    const REFERENCE: &'static str = "hourglass control: G. C. Ganzenmueller, Comput. Methods Appl. Mech. Engrg. 286 (2015) 87-106, in variational form";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        self.check()?;
        let (lagrangian, present) = split(sim)?;
        self.check_fit(&lagrangian, &present, sim)?;
        self.check_use(&lagrangian, &present, sim)?;
        if !lagrangian.is_empty() {
            self.add_to_lagrangian(lagrangian, sim)?;
        }
        for id in present.iter() {
            self.add_to_eulerian(id, sim)?;
        }
        Ok(())
    }
}

/// Whether the material of a body flows plastically.
fn flows(id: BodyId, sim: &SimBuilder<'_>) -> Result<bool, SetupError> {
    Ok(sim.body(id).solid_law()?.initial_yield_stress().is_some())
}

/// Whether the supports of a body follow its deformation.
fn follows(id: BodyId, sim: &SimBuilder<'_>) -> bool {
    sim.body(id).distances == Distances::PartWay
}

/// The bodies that take terms which fold into the internal force, and those that take pair terms alone: their
/// weights are not those of a reference.
fn split(sim: &SimBuilder<'_>) -> Result<(BodySet, BodySet), SetupError> {
    let solids = sim.scope_of(BodyKind::Solid)?;
    let folds = |id: &BodyId| sim.body(*id).offers(Offer::FoldedTerms);
    let pairs = |id: &BodyId| !folds(id) && sim.body(*id).offers(Offer::PairTerms);
    let (lagrangian, eulerian) =
        (BodySet::new(solids.iter().filter(folds)), BodySet::new(solids.iter().filter(pairs)));
    if lagrangian.is_empty() && eulerian.is_empty() {
        // It says what they do not take.
        return Ok((sim.scope_offering(Offer::FoldedTerms)?, eulerian));
    }
    Ok((lagrangian, eulerian))
}

impl HourglassControl {
    fn zeta(&self) -> f64 {
        self.zeta.unwrap_or(USUAL_ZETA)
    }

    fn chi(&self) -> f64 {
        self.chi.unwrap_or(USUAL_CHI)
    }

    /// The form of an Eulerian body, or of a Lagrangian one.
    fn form_of(&self, id: BodyId, is_eulerian: bool, sim: &SimBuilder<'_>) -> Result<Form, SetupError> {
        Ok(match self.form {
            // Where supports follow a plastic flow, the energy alone holds neighbours together.
            Form::Default if is_eulerian && !follows(id, sim) && flows(id, sim)? => Form::Combined,
            Form::Default => Form::Variational,
            form => form,
        })
    }

    fn check(&self) -> Result<(), SetupError> {
        ParameterError::require_not_negative("alpha", self.alpha.unwrap_or_default())?;
        ParameterError::require_not_negative("xi", self.xi.unwrap_or_default())?;
        ParameterError::require_not_negative("zeta", self.zeta())?;
        if !(0.0..=1.0).contains(&self.chi()) {
            let message = format!("`chi` must be from 0 to 1, found {}", self.chi());
            return Err(SetupError::parameter("chi", message, "it is the share of the viscous part"));
        }
        Ok(())
    }

    /// Whether form and coefficients are those of the bodies.
    fn check_fit(
        &self,
        lagrangian: &BodySet,
        eulerian: &BodySet,
        sim: &SimBuilder<'_>,
    ) -> Result<(), SetupError> {
        let (wrong, help) = match self.form {
            Form::Ganzenmueller2015 => (
                eulerian,
                "such bodies have `Variational`, `Stiffness`, `Viscous`, `Combined` and `MohseniMofidi2020`",
            ),
            Form::Stiffness | Form::MohseniMofidi2020 => {
                (lagrangian, "such bodies have `Variational`, `Ganzenmueller2015`, `Viscous` and `Combined`")
            }
            _ => (&BodySet::default(), ""),
        };
        if let Some(id) = wrong.iter().next() {
            let body = sim.body(id);
            let message = format!(
                "body `{}` moves by `{}`, which has no hourglass control of the form `{:?}`",
                body.name, body.formulation, self.form
            );
            return Err(SetupError::parameter("form", message, help));
        }
        let unused = if self.alpha.is_some() && lagrangian.is_empty() && !eulerian.is_empty() {
            Some(("alpha", "xi", "Lagrangian"))
        } else if self.xi.is_some() && eulerian.is_empty() && !lagrangian.is_empty() {
            Some(("xi", "alpha", "Eulerian"))
        } else {
            None
        };
        unused.map_or(Ok(()), |(given, meant, kind)| {
            let message = format!("`{given}` is the coefficient of {kind} bodies, and there is none here");
            Err(SetupError::parameter(given, message, format!("give `{meant}` instead, or neither")))
        })
    }

    /// Whether every coefficient belongs to the form of one of the bodies.
    fn check_use(
        &self,
        lagrangian: &BodySet,
        eulerian: &BodySet,
        sim: &SimBuilder<'_>,
    ) -> Result<(), SetupError> {
        let of = |bodies: &BodySet, is_eulerian| -> Result<Vec<Form>, SetupError> {
            bodies.iter().map(|id| self.form_of(id, is_eulerian, sim)).collect()
        };
        let forms = [of(lagrangian, false)?, of(eulerian, true)?].concat();
        let given = [
            ("alpha", self.alpha.is_some(), "an elastic part"),
            ("xi", self.xi.is_some(), "an elastic part"),
            ("zeta", self.zeta.is_some(), "a viscous part"),
            ("chi", self.chi.is_some(), "an elastic and a viscous part"),
            ("after_yield", self.after_yield != AfterYield::YieldStress, "an elastic part"),
        ];
        for (name, is_given, part) in given {
            let uses = |form: &Form| match name {
                "alpha" | "xi" | "after_yield" => *form != Form::Viscous,
                "zeta" => form.is_mixed() || *form == Form::Viscous,
                _ => form.is_mixed(),
            };
            if let Some(form) = forms.first().filter(|_| is_given && !forms.iter().any(uses)) {
                let message = format!("`{name}` is of forms with {part}, and `{form:?}` is none of them");
                return Err(SetupError::parameter(name, message, "leave it out, or give another `form`"));
            }
        }
        Ok(())
    }

    fn add_to_eulerian(&self, id: BodyId, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let (flows, form) = (flows(id, sim)?, self.form_of(id, true, sim)?);
        // Half of twice the coefficient where the other half is viscous.
        let [alone, other] = USUAL_XI;
        let (share, viscous, usual) = match form {
            Form::Variational => (1.0, 0.0, alone),
            Form::Stiffness => (1.0, 0.0, other),
            Form::Viscous => (0.0, 1.0, 0.0),
            _ => (1.0 - self.chi(), self.chi(), 2.0 * other),
        };
        // With Young's modulus after yield, neighbours that slide past each other would be resisted.
        let slides = flows && self.after_yield == AfterYield::Young;
        let resists_across = form == Form::Variational || form == Form::Combined && !slides;
        let elastic = Elastic {
            xi: share * self.xi.unwrap_or(usual),
            across: if resists_across { ACROSS } else { 0.0 },
            after_yield: self.after_yield,
            has_energy: !matches!(form, Form::Stiffness | Form::MohseniMofidi2020),
        };
        eulerian::add(elastic, viscous * self.zeta(), id, sim)
    }

    fn add_to_lagrangian(&self, bodies: BodySet, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let alpha = self.alpha.unwrap_or(if self.form == Form::Ganzenmueller2015 { 25.0 } else { 5.0 });
        match self.form {
            Form::Default | Form::Variational => self.add_variational(alpha, bodies, sim),
            Form::Ganzenmueller2015 => self.add_ganzenmueller_2015(alpha, &bodies, sim),
            Form::Viscous => add_viscous(self.zeta(), &bodies, sim),
            Form::Combined => {
                add_viscous(self.chi() * self.zeta(), &bodies, sim)?;
                self.add_variational((1.0 - self.chi()) * alpha, bodies, sim)
            }
            Form::Stiffness | Form::MohseniMofidi2020 => Ok(()),
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
            sim.add_column_to::<HourglassResidual>(&bodies);
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
                add_off_cracks(sim, id, WORK, OnIntactBonds(term));
            } else {
                let term = Ganzenmueller2015::<DeformationGradient> { alpha, density, measure: PhantomData };
                sim.add_pair_term(BodySet::new([id]), WORK, term);
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
        if can_fail(sim, id)? {
            let term = Viscous::<HourglassGradient>::of(zeta, id, sim)?;
            add_off_cracks(sim, id, VISCOSITY, OnIntactBonds(term));
        } else {
            let term = Viscous::<DeformationGradient>::of(zeta, id, sim)?;
            sim.add_pair_term(BodySet::new([id]), VISCOSITY, term);
        }
    }
    Ok(())
}
