//! The system of the first pass: every body with its law, its bond terms and the energies that they report.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::bond_terms::{BodyBondTerm, BondEnergy, BondMemory, BondTerm};
use super::damping::{self, DampedStrain, DampingRows, DampingStress};
use super::deformation::{DeformationPass, DeformationRows, DeformationSum, MAX_TERMS};
use super::edges::EdgeRows;
use super::formulation::PackedRows;
use super::frame::Frame;
use super::removed::RemovedRows;
use super::rows::pack;
use super::stable_step::StepEstimate;
use super::stretches;
use crate::materials::{MAX_STATE, SolidLaw, StateColumns, StateRows};
use crate::parallel::Split;
use crate::plugin::{SetupError, SimBuilder};
use crate::schedule::{AccountKind, Ledger, Run, Step, StepError};
use crate::world::{
    BodyId, Column, ColumnSet, Damage, DeformationGradient, HourglassGradient, HourglassMisfit,
    HourglassModulus, PhaseId, PiolaStress, Velocity, World,
};

/// A body as the deformation system sees it.
pub(super) struct BodyLaw {
    pub(super) id: BodyId,
    pub(super) law: Arc<dyn SolidLaw>,
    /// The state columns of its law.
    state: StateColumns,
    pub(super) estimate: StepEstimate,
    /// Accounts and indices into the list of terms.
    terms: Vec<usize>,
    /// Whether its short steps are damped.
    damped: bool,
    /// Factor of the stable step by the stretches of the body.
    stretch_factor: f64,
}

/// The law of a body, and what it is to be run with.
pub(super) fn body_law(
    id: BodyId,
    sim: &SimBuilder<'_>,
    all: &[BodyBondTerm],
    damped: bool,
) -> Result<BodyLaw, SetupError> {
    let body = sim.body(id);
    let terms: Vec<usize> = (0..all.len()).filter(|&k| all[k].bodies.contains(id)).collect();
    if terms.len() > MAX_TERMS {
        let message = format!("body `{}` has {} bond terms, more than {MAX_TERMS}", body.name, terms.len());
        return Err(SetupError::parameter("", message, "remove plugins that add bond terms"));
    }
    let law = Arc::clone(body.solid_law()?);
    let elastic = law.elastic();
    let density = body.material.density;
    let factor: f64 = terms.iter().map(|&k| all[k].term.stiffness_factor()).sum();
    let estimate = StepEstimate {
        wave: elastic.longitudinal_modulus() / density,
        bond: factor * elastic.young / density,
    };
    let mut columns = ColumnSet::default();
    law.state(&mut columns);
    let state = StateColumns::new(&columns).ok_or_else(|| {
        let message = format!("the material of body `{}` has more than {MAX_STATE} state columns", body.name);
        SetupError::parameter("", message, "this is a fault of the material, not of the scene")
    })?;
    Ok(BodyLaw { id, law, state, estimate, terms, damped, stretch_factor: 1.0 })
}

/// Steps between two looks at the stretches: they change slowly against the stable step.
const STRETCH_INTERVAL: u64 = 10;

/// The system.
pub(super) struct Deformation {
    pub(super) phase: PhaseId,
    pub(super) plane: bool,
    pub(super) laws: Vec<BodyLaw>,
    pub(super) terms: Vec<BodyBondTerm>,
    /// What the pass has found in each body.
    pub(super) found: Vec<DeformationSum>,
    sums: Vec<DeformationSum>,
    pub(super) removed: RemovedRows,
    /// Rows that had failed when the step began, and have not been removed; ascending.
    pub(super) failed: Vec<u32>,
}

impl Deformation {
    pub fn new(phase: PhaseId, plane: bool, laws: Vec<BodyLaw>, terms: Vec<BodyBondTerm>) -> Self {
        let (found, sums, removed) = (Vec::new(), Vec::new(), RemovedRows::default());
        Self { phase, plane, laws, terms, found, sums, removed, failed: Vec::new() }
    }

    /// The state columns of all laws.
    pub fn state(&self) -> ColumnSet {
        let mut columns = ColumnSet::default();
        self.laws.iter().for_each(|law| law.law.state(&mut columns));
        columns
    }

    /// Runs the pass over all bodies; states of laws advance by `dt`, s.
    pub(super) fn pass(
        &mut self,
        world: &World,
        packed: &mut PackedRows,
        (dt, is_short): (f64, bool),
    ) -> Result<(), StepError> {
        let view = world.phase(self.phase);
        let PackedRows { bonds, images, origin, sites, pair_stress, own_pull, frames, cracks, .. } = packed;
        pack(&view, *origin, self.removed.rows(), &mut sites[..view.len()])?;
        images.fill_sites(*origin, sites);
        let mut gradient = view.write::<DeformationGradient>()?;
        let mut stress = view.write::<PiolaStress>()?;
        let mut modulus = view.write::<HourglassModulus>().ok();
        let mut misfit = view.write::<HourglassMisfit>().ok();
        let mut strain = view.write::<DampedStrain>().ok();
        let mut damping = view.write::<DampingStress>().ok();
        let mut measured = view.write::<HourglassGradient>().ok();
        let velocity = view.read::<Velocity>()?;
        self.found.clear();
        frames.clear();
        for law in &self.laws {
            let rows = world.body(law.id).rows.clone();
            let mut terms: [&dyn BondTerm; MAX_TERMS] = [&NoTerm; MAX_TERMS];
            for (slot, &k) in terms.iter_mut().zip(&law.terms) {
                *slot = &*self.terms[k].term;
            }
            let middle = rows.start + rows.len() / 2;
            let frame = Frame::of(rows.end, &gradient[middle].0, &sites[middle]);
            frames.push(frame);
            let pass = DeformationPass {
                bonds,
                images,
                sites,
                law: &*law.law,
                terms: &terms[..law.terms.len()],
                frame: &frame,
                first_row: rows.start,
                refits: self.removed.refits(),
                marks: &cracks.marks,
                velocity: &velocity,
                plane: self.plane,
                dt,
                is_short,
            };
            let mut sum = DeformationSum::default();
            view.write_bytes_of(law.state.as_slice(), &mut |bytes| {
                let (_, state) = StateRows::new(&law.state, bytes).split(rows.start);
                let written = DeformationRows {
                    deformation: bytemuck::cast_slice_mut(&mut gradient[rows.clone()]),
                    stress: bytemuck::cast_slice_mut(&mut stress[rows.clone()]),
                    pair_stress: &mut pair_stress[rows.clone()],
                    own_pull: &mut own_pull[rows.clone()],
                    state: state.split(rows.len()).0,
                    memory: BondMemory {
                        modulus: modulus.as_deref_mut().map_or(&mut [], |all| rows_of(all, &rows)),
                        misfit: misfit.as_deref_mut().map_or(&mut [], |all| rows_of(all, &rows)),
                        gradient: measured.as_deref_mut().map_or(&mut [], |all| rows_of(all, &rows)),
                    },
                    damping: match (&mut strain, &mut damping) {
                        (Some(strain), Some(damping)) if law.damped => {
                            DampingRows { strain: rows_of(strain, &rows), stress: rows_of(damping, &rows) }
                        }
                        _ => DampingRows::default(),
                    },
                    edges: EdgeRows::of(&mut cracks.edges, rows.start, rows.len()),
                };
                sum = pass.run(written, &mut self.sums);
            });
            self.found.push(sum);
        }
        images.fill_pair_stress(frames, sites, pair_stress);
        cracks.settle();
        Ok(())
    }

    /// Books what the pass has found; stops where a body has turned inside out.
    pub(super) fn book(&self, step: &mut Step<'_>) -> Result<(), StepError> {
        for (law, sum) in self.laws.iter().zip(&self.found) {
            law.book(sum, &self.terms, step.ledger);
            if sum.inverted > 0 && law.law.needs_positive_volume() {
                let particle = sum.inverted - 1 - step.world.body(law.id).rows.start;
                return Err(step.unstable("negative volume (det F <= 0)", law.id, particle));
            }
        }
        Ok(())
    }
}

impl Run for Deformation {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        let mut packed = resources.get_mut::<PackedRows>();
        self.take_up_restored(step.world, &mut packed)?;
        self.take_up_failed(step.world, &mut packed)?;
        if !self.take_up_removed(step, &mut packed)? {
            self.pass(step.world, &mut packed, (step.clock.dt, step.turn.is_part()))?;
            self.book(step)?;
        }
        let view = step.world.phase(self.phase);
        let gradient = view.read::<DeformationGradient>()?;
        let damage = view.read::<Damage>().ok();
        for (law, stable_step) in self.laws.iter_mut().zip(&packed.stable_step) {
            let body = step.world.body(law.id);
            if step.clock.step.is_multiple_of(STRETCH_INTERVAL) {
                let damage = damage.as_deref().map(|damage| &damage[body.rows.clone()]);
                law.refresh(&gradient[body.rows.clone()], damage);
            }
            let by = fmt::from_fn(|f| law.write_cause(f, &body.name));
            step.limits.propose(stable_step * law.stretch_factor, by);
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        let factors: Vec<f64> = self.laws.iter().map(|law| law.stretch_factor).collect();
        postcard::to_stdvec(&(factors, self.removed.rows(), self.removed.refits().entries(), &self.failed))
            .unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        type Saved = (Vec<f64>, Vec<u32>, Vec<(u32, glam::DMat3)>, Vec<u32>);
        let Ok((factors, removed, refits, failed)) = postcard::from_bytes::<Saved>(state) else {
            return false;
        };
        if factors.len() != self.laws.len() {
            return false;
        }
        self.laws.iter_mut().zip(factors).for_each(|(law, factor)| law.stretch_factor = factor);
        self.removed = RemovedRows::restored(removed, refits);
        self.failed = failed;
        true
    }
}

/// Fills an unused slot of the list of terms.
struct NoTerm;

impl BondTerm for NoTerm {
    fn add(&self, _: &mut super::BondRows<'_>) -> BondEnergy {
        BondEnergy::default()
    }

    fn stiffness_factor(&self) -> f64 {
        0.0
    }
}

impl BodyLaw {
    fn book(&self, sum: &DeformationSum, terms: &[BodyBondTerm], ledger: &mut Ledger) {
        let strain = ledger.account("strain", AccountKind::Stored);
        ledger.set(strain, self.id, sum.strain);
        if self.damped {
            let damping = ledger.account(damping::ACCOUNT, AccountKind::Dissipated);
            ledger.add(damping, self.id, sum.damped);
        }
        if !self.state.as_slice().is_empty() {
            let plastic = ledger.account("plastic_work", AccountKind::Dissipated);
            ledger.add(plastic, self.id, sum.plastic_work);
        }
        for (&k, energy) in self.terms.iter().zip(sum.terms) {
            let BodyBondTerm { account, released, .. } = &terms[k];
            if let Some(name) = account {
                // Terms of one account hold its energy together.
                let own = |(other, _): &(&usize, BondEnergy)| terms[**other].account.as_ref() == Some(name);
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

    fn refresh(&mut self, gradient: &[DeformationGradient], damage: Option<&[Damage]>) {
        self.stretch_factor = self.law.stable_step_factor(&stretches::of_body(gradient, damage));
    }

    fn write_cause(&self, f: &mut fmt::Formatter<'_>, body: &str) -> fmt::Result {
        let cause = if self.estimate.bond_limited() { "bond stiffness" } else { "wave speed" };
        if self.stretch_factor < 0.99 {
            write!(f, "{cause} of `{body}` at a stretch factor of {:.2}", self.stretch_factor)
        } else {
            write!(f, "{cause} of `{body}`")
        }
    }
}

/// The rows of a body in a column.
fn rows_of<'a, C: Column>(column: &'a mut [C], rows: &Range<usize>) -> &'a mut [C::Value] {
    bytemuck::cast_slice_mut(&mut column[rows.clone()])
}
