//! The pass over pairs that runs all pair terms.

use std::cell::RefCell;
use std::ops::DerefMut;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::bound::{Chain, ErasedTerm, bind_all};
use super::row::PairRow;
use super::term::{BodyPairTerm, RowRates};
use super::work;
use crate::parallel::{BlockSum, Split, for_each_block};
use crate::plugin::{SetupError, SimBuilder};
use crate::scene::Dimension;
use crate::schedule::{Run, Stage, Step, StepError, System};
use crate::world::{BodyId, Column, DensityRate, Force, PhaseId};

/// Largest number of pair terms on one body.
pub(super) const MAX_TERMS: usize = 8;
/// Share of the critical step that is used where a stiff pair term limits it.
const STIFFNESS_SAFETY: f64 = 0.65;
/// Share of the step at which a damping pair term would turn a velocity around.
const DAMPING_SAFETY: f64 = 0.5;

thread_local! {
    /// The geometry of one row; kept, so that a step does not allocate.
    static ROW: RefCell<PairRow> = RefCell::default();
}

/// The pairs of one body.
pub trait PairRows: Sync {
    /// Puts the neighbours of particle i into `row`, in the order of its neighbour list; with their kernel values where a term
    /// reads them.
    fn row(&self, i: usize, with_kernel: bool, row: &mut PairRow);
}

/// Where a formulation keeps its pairs.
pub trait PairSource: Send + 'static {
    /// Calls `run` with the pairs of a body.
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError>;
}

/// Takes the pair terms of the bodies of a phase out of the builder, and adds the pass that runs them after the
/// system `after`, and the booking of their work. Without terms nothing is added. Returns the account of the first term
/// that changes the density.
pub fn add_pair_systems(
    sim: &mut SimBuilder<'_>,
    phase: PhaseId,
    after: &'static str,
    source: impl PairSource,
) -> Result<Option<String>, SetupError> {
    let (own, others): (Vec<BodyPairTerm>, Vec<BodyPairTerm>) = sim
        .take_extensions::<BodyPairTerm>()
        .into_iter()
        .partition(|term| term.bodies.iter().any(|id| sim.body(id).phase == phase));
    others.into_iter().for_each(|term| sim.extend(term));
    if own.is_empty() {
        return Ok(None);
    }
    let of_density = own.iter().find(|term| term.term.changes_density()).map(|term| term.account.clone());
    let ids: Vec<BodyId> =
        sim.bodies().iter().filter(|body| body.phase == phase).map(|body| body.id).collect();
    let mut bodies = Vec::new();
    for id in ids {
        let terms: Vec<usize> = (0..own.len()).filter(|&k| own[k].bodies.contains(id)).collect();
        if terms.len() > MAX_TERMS {
            let name = &sim.body(id).name;
            let message = format!("body `{name}` has {} pair terms, more than {MAX_TERMS}", terms.len());
            return Err(SetupError::parameter("", message, "remove plugins that add pair terms"));
        }
        if !terms.is_empty() {
            bodies.push(BodyTerms { id, terms, forces: Vec::new() });
        }
    }
    let read: Vec<_> = own.iter().flat_map(|term| term.term.access()).collect();
    let accounts = own.iter().map(|term| term.account.clone()).collect();
    let terms = own.into_iter().map(|term| term.term).collect();
    let bodies = Arc::new(Mutex::new(bodies));
    let work = PairPass { phase, source, terms, bodies: Arc::clone(&bodies), sums: Vec::new() };
    let mut pass =
        System::new(Stage::Rates, "pair_terms", work).on_phases([phase]).adds::<Force>().after(after);
    if sim.columns(phase).get(DensityRate::NAME).is_some() {
        pass = pass.writes::<DensityRate>();
    }
    for access in read {
        pass = pass.touches(access.column, access.mode);
    }
    sim.add_system(pass);
    work::add_work_systems(sim, phase, accounts, bodies);
    Ok(of_density)
}

/// The terms of one body, and the force of each on every particle of it: row by row, one entry a term. The forces are
/// made anew in every step, so no checkpoint holds them.
pub(crate) struct BodyTerms {
    pub id: BodyId,
    pub terms: Vec<usize>,
    pub forces: Vec<DVec3>,
}

/// The pass over all pairs of a phase.
struct PairPass<S> {
    phase: PhaseId,
    source: S,
    terms: Vec<Box<dyn ErasedTerm>>,
    bodies: Arc<Mutex<Vec<BodyTerms>>>,
    sums: Vec<Fastest>,
}

/// The largest rates of a block.
#[derive(Clone, Copy, Debug, Default)]
struct Fastest {
    damping: f64,
    stiffness: f64,
}

impl BlockSum for Fastest {
    #[inline]
    fn add(&mut self, next: &Self) {
        self.damping = self.damping.max(next.damping);
        self.stiffness = self.stiffness.max(next.stiffness);
    }
}

/// Forces of a block: the total, and that of every term.
struct ForceRows<'a> {
    total: &'a mut [Force],
    by_term: &'a mut [DVec3],
    terms: usize,
    /// Density rates; empty where the phase has none.
    density: &'a mut [DensityRate],
}

impl Split for ForceRows<'_> {
    fn rows(&self) -> usize {
        self.total.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let terms = self.terms;
        let (total, total_rest) = self.total.split_at_mut(at);
        let (by_term, by_term_rest) = self.by_term.split_at_mut(at * terms);
        let (density, density_rest) = self.density.split_at_mut(at.min(self.density.len()));
        (
            Self { total, by_term, terms, density },
            Self { total: total_rest, by_term: by_term_rest, terms, density: density_rest },
        )
    }
}

impl<S: PairSource> Run for PairPass<S> {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let mut force = view.write::<Force>()?;
        let mut density = if view.has::<DensityRate>() { Some(view.write::<DensityRate>()?) } else { None };
        let mut bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        for BodyTerms { id, terms: indices, forces } in bodies.deref_mut() {
            let body = step.world.body(*id);
            let rows = body.rows.clone();
            let Some(&first) = indices.first() else { continue };
            let mut slots = [&*self.terms[first]; MAX_TERMS];
            slots.iter_mut().zip(indices.iter()).for_each(|(slot, &k)| *slot = &*self.terms[k]);
            let terms = &slots[..indices.len()];
            forces.resize(rows.len() * terms.len(), DVec3::ZERO);
            let with_kernel = terms.iter().any(|term| term.reads_kernel());
            let plane = step.world.dimension() == Dimension::Two;
            let mut fastest = Fastest::default();
            let sums = &mut self.sums;
            self.source.with_rows(step, *id, &mut |pairs| {
                bind_all(terms, &view, None, &mut |chain| {
                    let written = ForceRows {
                        total: &mut force[rows.clone()],
                        by_term: forces,
                        terms: terms.len(),
                        density: density.as_mut().map_or(&mut [], |density| &mut density[rows.clone()]),
                    };
                    fastest = for_each_block(written, sums, &|first, block| {
                        run_block(chain, pairs, (with_kernel, plane), rows.start + first, block)
                    });
                })?;
                Ok(())
            })?;
            if fastest.damping > 0.0 {
                let limit = DAMPING_SAFETY / fastest.damping;
                step.limits.propose(limit, format_args!("viscosity of `{}`", body.name));
            }
            if fastest.stiffness > 0.0 {
                let limit = STIFFNESS_SAFETY * 2.0 / fastest.stiffness.sqrt();
                step.limits.propose(limit, format_args!("pair stiffness of `{}`", body.name));
            }
        }
        Ok(())
    }
}

fn run_block(
    chain: &Chain<'_>,
    pairs: &dyn PairRows,
    (with_kernel, plane): (bool, bool),
    first: usize,
    block: ForceRows<'_>,
) -> Fastest {
    let mut fastest = Fastest::default();
    ROW.with_borrow_mut(|row| {
        for (k, total) in block.total.iter_mut().enumerate() {
            pairs.row(first + k, with_kernel, row);
            let mut rates = [RowRates::default(); MAX_TERMS];
            let rates = &mut rates[..block.terms];
            chain.row(first + k, row, plane, rates);
            let mut sum = Fastest::default();
            if let Some(density) = block.density.get_mut(k) {
                density.0 = rates.iter().map(|rates| rates.density).sum();
            }
            for (rates, force) in rates.iter().zip(&mut block.by_term[k * block.terms..]) {
                *force = rates.force;
                total.0 += rates.force;
                sum.damping += rates.damping;
                sum.stiffness += rates.stiffness;
            }
            fastest.add(&sum);
        }
    });
    fastest
}
