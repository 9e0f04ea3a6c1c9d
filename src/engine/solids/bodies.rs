//! The bodies of a solid formulation: law, folded terms and energies of each.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use glam::DMat3;

use super::constitutive::{CRUSHED, Constitutive, MAX_TERMS, SolidBlock, SolidColumns, SolidRows, SolidSum};
use super::damping::{self, DampedStrain, DampedSubSteps, DampingStress};
use super::folded::{FoldedEnergy, FoldedRows, FoldedTerm, FoldedTermOfBodies};
use super::hessian::{self, HessianDifference, HessianForm, HessianResidual, HessianStiffness};
use super::pair_control::{self, PairControl};
use super::refit::Refits;
use super::stable_step::{BodyStep, StepEstimate};
use super::stretches::{self, Resisting};
use super::thin_body::stiffness_of_thin;
use crate::materials::{MAX_STATE, SolidLaw, StateColumns, StateRows, Stretches};
use crate::parallel::{Split, for_each_block, for_each_own_block};
use crate::plugin::{BodyPlan, ForBodies, Offer, SetupError, SimBuilder};
use crate::schedule::{AccountKind, Ledger, Step, StepError};
use crate::world::{
    BodyId, BodySet, Column, ColumnSet, Damage, DeformationGradient, HourglassGradient, HourglassModulus,
    HourglassResidual, PhaseId, PhaseView,
};

/// A body of a solid formulation.
pub struct SolidBody {
    /// Body.
    pub id: BodyId,
    /// Law of its material.
    pub law: Arc<dyn SolidLaw>,
    /// The state columns of its law.
    state: StateColumns,
    /// Estimate of its stable step.
    pub estimate: StepEstimate,
    /// Its folded terms.
    terms: Vec<usize>,
    /// Its stabilization by differences of second derivatives.
    pub hessian: Option<HessianDifference>,
    /// Its control along pairs.
    pub control: Option<PairControl>,
    /// The damping of its sub-steps, if they are damped.
    damping: Option<DampedSubSteps>,
    /// Its stable step.
    step: BodyStep,
}

/// All bodies of a solid formulation, in the order of the scene.
pub struct SolidBodies {
    phase: PhaseId,
    bodies: Vec<SolidBody>,
    terms: Vec<Arc<FoldedTermOfBodies>>,
    /// Columns of state beside deformation gradient and stress.
    pub(super) columns: ColumnSet,
    pub(super) can_fail: bool,
    /// Results of the last pass for each body.
    found: Vec<SolidSum>,
    sums: Vec<SolidSum>,
}

/// The part of a step that a pass belongs to.
#[derive(Clone, Copy)]
pub struct SolidPart<'a> {
    /// Length of the step, s; zero before the first, and where a pass is repeated: states of laws then stay.
    pub dt: f64,
    /// Length of the long step of which the step is one of several short ones, s.
    pub long: Option<f64>,
    /// Measures of deformation that outlast cuts in the neighbourhood, for formulations that cut.
    pub refits: Option<&'a Refits>,
}

impl SolidPart<'_> {
    /// A pass that is repeated: states of laws stay.
    pub const REPEATED: Self = Self { dt: 0.0, long: None, refits: None };

    /// That of a step.
    pub fn of(step: &Step<'_>) -> Self {
        Self { dt: step.clock.dt, long: step.part.long_step(), refits: None }
    }
}

/// The pass over one body.
#[derive(Clone)]
pub struct BodyPass<'a> {
    /// Number of the body among those of the formulation.
    pub body: usize,
    /// Columns of the phase.
    pub view: &'a PhaseView<'a>,
    /// Rows of the body.
    pub rows: Range<usize>,
    /// The part of the step.
    pub part: SolidPart<'a>,
}

/// Fills an unused slot of the list of terms.
struct NoTerm;

impl FoldedTerm for NoTerm {
    fn add(&self, _: &mut FoldedRows<'_>) -> FoldedEnergy {
        FoldedEnergy::default()
    }

    fn stiffness_factor(&self) -> f64 {
        0.0
    }
}

impl SolidBodies {
    /// Takes what plugins have handed in for the bodies of a formulation, which are of one phase, and gives
    /// these the columns that go with it.
    ///
    /// # Errors
    /// A body whose material is not a solid, or one with too many terms.
    pub fn new(ids: &[BodyId], sim: &mut SimBuilder<'_>) -> Result<Self, SetupError> {
        let own = BodySet::new(ids.iter().copied());
        let terms: Vec<ForBodies<FoldedTermOfBodies>> = sim.take_for(&own);
        let hessian: Vec<ForBodies<HessianDifference>> =
            sim.take_for(&offering(ids, Offer::HessianDifferences, sim));
        let control: Vec<ForBodies<PairControl>> = sim.take_for(&offering(ids, Offer::PairControl, sim));
        let damped: Vec<ForBodies<DampedSubSteps>> = sim.take_for(&own);
        damped.iter().for_each(|ForBodies { bodies, .. }| {
            sim.add_column_to::<DampedStrain>(bodies);
            sim.add_column_to::<DampingStress>(bodies);
        });
        let damping = |id| damped.iter().find(|own| own.bodies.contains(id)).map(|own| *own.value);
        let body = |&id: &BodyId| {
            let own = control.iter().filter(|own| own.bodies.contains(id)).map(|own| *own.value);
            let sum =
                |a: PairControl, b: PairControl| PairControl { xi: a.xi + b.xi, across: a.across + b.across };
            let control = own.reduce(sum);
            let body = SolidBody::new(id, sim, &terms, &hessian, damping(id));
            body.map(|body| SolidBody { control, ..body }).map_err(|error| error.of_formulation(id))
        };
        let bodies = ids.iter().map(body).collect::<Result<Vec<_>, _>>()?;
        let has_residual = bodies.iter().any(SolidBody::has_hessian_residual);
        if has_residual {
            sim.add_column_to::<HessianResidual>(&own);
            sim.add_column_to::<HessianStiffness>(&own);
        }
        let phase = sim.body(ids[0]).phase;
        let mut columns = ColumnSet::default();
        bodies.iter().for_each(|body| body.law.state(&mut columns));
        if sim.columns(phase).get(HourglassModulus::NAME).is_some() {
            columns.add::<HourglassModulus>().add::<HourglassResidual>();
        }
        if !damped.is_empty() {
            columns.add::<DampedStrain>().add::<DampingStress>();
        }
        if sim.columns(phase).get(HourglassGradient::NAME).is_some() {
            columns.add::<HourglassGradient>();
        }
        if has_residual {
            columns.add::<HessianResidual>().add::<HessianStiffness>();
        }
        let terms = terms.into_iter().map(|term| term.value).collect();
        let can_fail = sim.columns(phase).get(Damage::NAME).is_some();
        Ok(Self { phase, bodies, terms, columns, can_fail, found: Vec::new(), sums: Vec::new() })
    }

    /// Checks that all folded terms only read, for formulations that apply none.
    ///
    /// # Errors
    /// The first body with another term.
    pub fn require_terms_that_look(&self, sim: &SimBuilder<'_>) -> Result<(), SetupError> {
        let adds = |body: &&SolidBody| body.terms.iter().any(|&k| !self.terms[k].term.only_looks());
        self.bodies.iter().find(adds).map_or(Ok(()), |own| {
            let BodyPlan { name, formulation, .. } = sim.body(own.id);
            let message = format!(
                "body `{name}` is given a term that folds into the internal force, and its formulation `{formulation}` takes none"
            );
            let help = "leave out the plugin that adds it, or give the body a Lagrangian formulation";
            Err(SetupError::parameter("", message, help).of_formulation(own.id))
        })
    }

    /// The bodies.
    pub fn iter(&self) -> impl Iterator<Item = &SolidBody> {
        self.bodies.iter()
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Body `k`.
    pub fn id(&self, k: usize) -> BodyId {
        self.bodies[k].id
    }

    /// Results of the last pass for each body.
    pub fn found(&self) -> &[SolidSum] {
        &self.found
    }

    /// Adds the energy of the difference of Laplacians of body `k` to the results of the last pass.
    pub fn add_hessian(&mut self, k: usize, energy: FoldedEnergy) {
        self.found[k].hessian = energy;
    }

    /// Adds the energy of the control along pairs of body `k` to the results of the last pass.
    pub fn add_control(&mut self, k: usize, energy: FoldedEnergy) {
        self.found[k].control = energy;
    }

    /// Resets the energies released by terms in the last pass.
    pub(super) fn forget_released(&mut self) {
        for sum in &mut self.found {
            let energies = sum.terms.iter_mut().chain([&mut sum.hessian, &mut sum.control]);
            energies.for_each(|energy| energy.released = 0.0);
        }
    }

    /// Whether there are folded terms.
    pub fn has_terms(&self) -> bool {
        !self.terms.is_empty()
    }

    /// Begins a pass over all bodies.
    pub fn begin(&mut self) {
        self.found.clear();
    }

    /// Runs the pass over a body, block by block: `block` is called with the rows of the block, those of
    /// `own`, which the formulation writes itself, and memory for a block, with the contents of the last one.
    pub fn run<O: Split>(
        &mut self,
        pass: BodyPass<'_>,
        columns: &mut SolidColumns<'_>,
        own: O,
        block: &(impl Fn(&Constitutive<'_>, SolidRows<'_>, O, &mut SolidBlock) -> SolidSum + Sync),
    ) {
        let Self { bodies, terms: all, found, sums, .. } = self;
        let BodyPass { body, view, rows, part } = pass;
        let body = &bodies[body];
        let mut terms: [&dyn FoldedTerm; MAX_TERMS] = [&NoTerm; MAX_TERMS];
        for (slot, &k) in terms.iter_mut().zip(&body.terms) {
            *slot = &*all[k].term;
        }
        let SolidPart { dt, long, refits } = part;
        let terms = &terms[..body.terms.len()];
        let damping = damping::share_in(dt, long.zip(body.damping), body.step.stable);
        let constitutive = Constitutive { law: &*body.law, terms, refits, dt, damping };
        let (mut own, first_row) = (Some(own), rows.start);
        let is_divided = columns.is_divided;
        let mut of_state = |bytes: [&mut [u8]; MAX_STATE]| {
            let Some(own) = own.take() else { return };
            let (_, state) = StateRows::new(&body.state, bytes).split(rows.start);
            let written = columns.rows(&rows, state.split(rows.len()).0, body.damping.is_some());
            let all = (written, own);
            let body = |first, (rows, own): (SolidRows<'_>, O)| {
                SolidBlock::with(first_row + first, |scratch| block(&constitutive, rows, own, scratch))
            };
            found.push(match is_divided {
                true => for_each_own_block(all, sums, &body),
                false => for_each_block(all, sums, &body),
            });
        };
        match is_divided {
            true => view.write_own_bytes_of(body.state.as_slice(), &mut of_state),
            false => view.write_bytes_of(body.state.as_slice(), &mut of_state),
        }
    }

    /// Books the results of the pass; stops where a body has inverted.
    ///
    /// # Errors
    /// A particle with det F <= 0 whose law has no meaning for it.
    pub fn book(&self, step: &mut Step<'_>) -> Result<(), StepError> {
        for (body, sum) in self.bodies.iter().zip(&self.found) {
            body.book(sum, &self.terms, step.ledger);
            if sum.inverted > 0 && body.law.needs_positive_volume() {
                let particle = sum.inverted - 1 - step.world.body(body.id).rows.start;
                return Err(step.unstable(CRUSHED[0], body.id, particle).with_detail(CRUSHED[1]));
            }
        }
        Ok(())
    }

    /// Proposes the stable step of each body, s: that of its undeformed state times a factor of its
    /// stretches. The rows of the phase carry `shares` of their stress; empty: all of it.
    ///
    /// # Errors
    /// The phase has no deformation gradient.
    pub fn limit(
        &mut self,
        step: &mut Step<'_>,
        undeformed: &[f64],
        shares: &[f64],
    ) -> Result<(), StepError> {
        self.limit_by(step, (undeformed, shares), |_, law, gradient, resisting| {
            law.stable_step_factor(&stretches::of_body(gradient, resisting))
        })
    }

    /// The same for stable steps, s, with the weights of the present configuration: of the stretches, only
    /// the change of volume counts, as that of all lengths alike.
    ///
    /// # Errors
    /// The phase has no deformation gradient.
    pub fn limit_from_present(&mut self, step: &mut Step<'_>, present: &[f64]) -> Result<(), StepError> {
        let axes = step.world.dimension().count() as f64;
        self.limit_by(step, (present, &[]), |_, law, gradient, resisting| {
            let Stretches { smallest_volume, largest_volume, .. } = stretches::of_body(gradient, resisting);
            let smallest = smallest_volume.max(0.0).powf(1.0 / axes);
            law.stable_step_factor(&Stretches { smallest, largest: 1.0, smallest_volume, largest_volume })
        })
    }

    /// The same for stable steps, s, in a reference configuration that follows the body, as if it were
    /// unstressed there. `reference` gives the deformation gradients of the rows of a body in its reference
    /// configuration, where that is not the undeformed one.
    ///
    /// # Errors
    /// The phase has no deformation gradient.
    pub fn limit_since<'r>(
        &mut self,
        step: &mut Step<'_>,
        unstressed: &[f64],
        shares: &[f64],
        reference: impl Fn(usize) -> Option<&'r [DMat3]>,
    ) -> Result<(), StepError> {
        self.limit_by(step, (unstressed, shares), |k, law, gradient, resisting| {
            let stretches = stretches::of_body(gradient, resisting);
            match reference(k) {
                None => law.stable_step_factor(&stretches),
                Some(reference) => {
                    stretches::min_stretch_since(gradient, reference, resisting) / law.wave_factor(&stretches)
                }
            }
        })
    }

    fn limit_by(
        &mut self,
        step: &mut Step<'_>,
        (stable, shares): (&[f64], &[f64]),
        factor: impl Fn(usize, &dyn SolidLaw, &[DeformationGradient], Resisting<'_>) -> f64,
    ) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let gradient = view.read_own::<DeformationGradient>()?;
        let damage = view.read_own::<Damage>().ok();
        for (k, (own, stable_step)) in self.bodies.iter_mut().zip(stable).enumerate() {
            let body = step.world.body(own.id);
            let damped = step.part.long_step().zip(own.damping);
            if own.step.is_stale(step.part.number(), damped.is_some()) {
                let resisting = Resisting::of_rows(body.rows.clone(), damage.as_deref(), shares);
                own.step.stretch(factor(k, &*own.law, &gradient[body.rows.clone()], resisting));
            }
            own.step.stable = stable_step * own.step.stretch_factor;
            let limit = damping::stable_step(damped, own.step.stable);
            step.limits.propose(limit, fmt::from_fn(|f| own.write_cause(f, &body.name)));
        }
        Ok(())
    }

    /// State of the bodies in a checkpoint: for [`Run::save`](crate::schedule::Run::save).
    pub fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.steps()).unwrap_or_default()
    }

    /// Restores the state of [`SolidBodies::save`]. Returns `false` where it does not fit.
    pub fn restore(&mut self, state: &[u8]) -> bool {
        postcard::from_bytes::<Vec<BodyStep>>(state).is_ok_and(|steps| self.restore_steps(&steps))
    }

    /// The stable step of each body, for those that keep more than these.
    pub fn steps(&self) -> Vec<BodyStep> {
        self.bodies.iter().map(|body| body.step).collect()
    }

    /// Restores those of [`SolidBodies::steps`]. Returns `false` where they do not fit.
    pub fn restore_steps(&mut self, steps: &[BodyStep]) -> bool {
        self.bodies.iter_mut().zip(steps).for_each(|(body, step)| body.step = *step);
        steps.len() == self.bodies.len()
    }
}

/// The bodies whose formulation has an offer.
fn offering(ids: &[BodyId], offer: Offer, sim: &SimBuilder<'_>) -> BodySet {
    BodySet::new(ids.iter().copied().filter(|id| sim.body(*id).offers(offer)))
}

impl SolidBody {
    fn new(
        id: BodyId,
        sim: &SimBuilder<'_>,
        all: &[ForBodies<FoldedTermOfBodies>],
        hessian: &[ForBodies<HessianDifference>],
        damping: Option<DampedSubSteps>,
    ) -> Result<Self, SetupError> {
        let body = sim.body(id);
        let terms: Vec<usize> = (0..all.len()).filter(|&k| all[k].bodies.contains(id)).collect();
        if terms.len() > MAX_TERMS {
            let message =
                format!("body `{}` has {} folded terms, more than {MAX_TERMS}", body.name, terms.len());
            return Err(SetupError::parameter("", message, "remove plugins that add folded terms"));
        }
        let mut hessian = hessian.iter().filter(|own| own.bodies.contains(id)).map(|own| *own.value);
        let (hessian, more) = (hessian.next(), hessian.next());
        if more.is_some() {
            let message = format!("body `{}` has two stabilizations by second derivatives", body.name);
            return Err(SetupError::parameter("", message, "leave one of them"));
        }
        if hessian.is_some_and(|own| own.form == HessianForm::Vidal2007) && !terms.is_empty() {
            let message = format!("body `{}` has another stabilization beside `Vidal2007`", body.name);
            return Err(SetupError::parameter("", message, "leave one of them, or use `FrameIndifferent`"));
        }
        let law = Arc::clone(body.solid_law()?);
        let elastic = law.elastic();
        let density = body.material.density;
        let factor: f64 = terms.iter().map(|&k| all[k].value.term.stiffness_factor()).sum();
        let thin = stiffness_of_thin(body, elastic, sim.dimension().count(), &sim.periodic());
        let estimate = StepEstimate {
            wave: thin * elastic.longitudinal_modulus() / density,
            bond: factor * elastic.young / density,
            hessian: hessian.map_or(0.0, |HessianDifference { eta, form }| match form {
                HessianForm::FrameIndifferent => eta * eta * elastic.young / density,
                HessianForm::Vidal2007 => eta * eta * elastic.longitudinal_modulus() / density,
            }),
        };
        let mut columns = ColumnSet::default();
        law.state(&mut columns);
        let state = StateColumns::new(&columns).ok_or_else(|| {
            let message = format!("the material of `{}` has more than {MAX_STATE} state columns", body.name);
            SetupError::parameter("", message, "this is a fault of the material, not of the scene")
        })?;
        let step = BodyStep::default();
        Ok(Self { id, law, state, estimate, terms, hessian, control: None, damping, step })
    }

    /// Whether it has folded terms.
    pub fn has_terms(&self) -> bool {
        !self.terms.is_empty()
    }

    /// Whether it has a stabilization with an energy.
    pub fn has_hessian_residual(&self) -> bool {
        self.hessian.is_some_and(|own| own.form == HessianForm::FrameIndifferent)
    }

    /// Whether a stabilizer resists zero-energy modes.
    pub fn is_stabilized(&self) -> bool {
        !self.terms.is_empty() || self.hessian.is_some()
    }

    fn book(&self, sum: &SolidSum, terms: &[Arc<FoldedTermOfBodies>], ledger: &mut Ledger) {
        let strain = ledger.account("strain", AccountKind::Stored);
        ledger.set(strain, self.id, sum.strain);
        if self.damping.is_some() {
            let damping = ledger.account(damping::ACCOUNT, AccountKind::Dissipated);
            ledger.add(damping, self.id, sum.damped);
        }
        if !self.state.as_slice().is_empty() {
            let plastic = ledger.account("plastic_work", AccountKind::Dissipated);
            ledger.add(plastic, self.id, sum.plastic_work);
        }
        if self.has_hessian_residual() {
            let account = ledger.account(hessian::ACCOUNT, AccountKind::Stored);
            ledger.set(account, self.id, sum.hessian.stored);
            if !self.state.as_slice().is_empty() {
                let released = ledger.account(hessian::RELEASED, AccountKind::Dissipated);
                ledger.add(released, self.id, sum.hessian.released);
            }
        }
        if self.control.is_some() {
            pair_control::book(sum.control, !self.state.as_slice().is_empty(), self.id, ledger);
        }
        for (&k, energy) in self.terms.iter().zip(sum.terms) {
            let FoldedTermOfBodies { account, released, .. } = &*terms[k];
            if let Some(name) = account {
                // Terms of one account hold its energy together.
                let own = |(other, _): &(&usize, FoldedEnergy)| terms[**other].account.as_ref() == Some(name);
                let all = self.terms.iter().zip(sum.terms).filter(own);
                let stored = all.map(|(_, energy)| energy.stored).sum();
                let account = ledger.account(name, AccountKind::Stored);
                ledger.set(account, self.id, stored);
            }
            if let Some(released) = released {
                let released = ledger.account(released, AccountKind::Dissipated);
                ledger.add(released, self.id, energy.released);
            }
        }
    }

    fn write_cause(&self, f: &mut fmt::Formatter<'_>, body: &str) -> fmt::Result {
        let cause = if self.estimate.bond_limited() { "bond stiffness" } else { "wave speed" };
        if self.step.stretch_factor < 0.99 {
            write!(f, "{cause} of `{body}` at a stretch factor of {:.2}", self.step.stretch_factor)
        } else {
            write!(f, "{cause} of `{body}`")
        }
    }
}
