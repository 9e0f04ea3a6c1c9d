//! The pair terms of the bodies of a phase, and their forces and rates.

use std::sync::Arc;

use glam::DVec3;

use super::batch::{MAX_ROWS, PairBatch};
use super::block::{BlockPairs, TermSums};
use super::body_terms::{BodyTerms, MAX_TERMS};
use super::bound::{Chain, RowsOut, bind_all};
use super::handed_in::PairTermOfBodies;
use super::rate_bounds::RateBounds;
use super::term::PairReads;
use super::work;
use crate::parallel::{BlockSum, Split};
use crate::plugin::{BodyKind, ForBodies, SetupError, SimBuilder};
use crate::scene::Dimension;
use crate::schedule::{Access, Mode, Shared, Step, StepError};
use crate::world::{BodyId, BodySet, Column, DensityRate, Force, PhaseId, ReferenceVolume, ViscousPower};

/// The terms of all bodies of a phase.
pub(crate) struct PhaseTerms {
    terms: Vec<Arc<PairTermOfBodies>>,
    bodies: BodySet,
    /// The bodies whose density a term changes.
    of_changing_density: BodySet,
    /// Forces and rates of the terms, shared with the systems that book their work.
    forces: Shared<Vec<BodyTerms>>,
    sums: Vec<RateBounds>,
    /// Reads of the terms from the pairs.
    pub reads: PairReads,
    /// Account of the first term that changes the density.
    pub of_density: Option<String>,
}

impl PhaseTerms {
    /// Takes the pair terms of the bodies of a phase from the builder, and adds the booking of their work;
    /// none where there are no terms. They are to be run in a system that declares their access.
    pub fn take(sim: &mut SimBuilder<'_>, phase: PhaseId) -> Result<Option<Self>, SetupError> {
        let of_phase =
            BodySet::new(sim.bodies().iter().filter(|body| body.phase == phase).map(|body| body.id));
        let own: Vec<ForBodies<PairTermOfBodies>> = sim.take_for(&of_phase);
        if own.is_empty() {
            return Ok(None);
        }
        let of_density = own.iter().map(|term| &term.value).find(|term| term.term.changes_density());
        let of_density = of_density.map(|term| term.account.clone());
        let mut bodies = Vec::new();
        for id in of_phase.iter() {
            let terms: Vec<usize> = (0..own.len()).filter(|&k| own[k].bodies.contains(id)).collect();
            if terms.len() > MAX_TERMS {
                let name = &sim.body(id).name;
                let message = format!("body `{name}` has {} pair terms, more than {MAX_TERMS}", terms.len());
                return Err(SetupError::parameter("", message, "remove plugins that add pair terms"));
            }
            let without = terms.iter().map(|&k| &own[k].value).find(|own| own.term.needs_reference());
            if sim.body(id).kind == BodyKind::Fluid
                && let Some(PairTermOfBodies { account, .. }) = without.map(|own| &**own)
            {
                let name = &sim.body(id).name;
                let message =
                    format!("body `{name}`, a fluid, has no reference for the pair term `{account}`");
                return Err(SetupError::parameter("", message, "give the term to solids alone"));
            }
            if !terms.is_empty() {
                bodies.push(BodyTerms { id, terms, forces: Vec::new() });
            }
        }
        let accounts = own.iter().map(|term| term.value.account.clone()).collect();
        let terms: Vec<Arc<PairTermOfBodies>> = own.into_iter().map(|term| term.value).collect();
        let mut reads = PairReads::default();
        for term in &terms {
            reads.kernel |= term.term.reads().kernel;
            reads.velocity |= term.term.reads().velocity;
        }
        let changes = |body: &&BodyTerms| body.terms.iter().any(|&k| terms[k].term.changes_density());
        let of_changing_density = BodySet::new(bodies.iter().filter(changes).map(|body| body.id));
        let ids = BodySet::new(bodies.iter().map(|body| body.id));
        let forces = sim.share(bodies);
        work::add_work_systems(sim, phase, accounts, forces);
        Ok(Some(Self {
            terms,
            bodies: ids,
            of_changing_density,
            forces,
            sums: Vec::new(),
            reads,
            of_density,
        }))
    }

    /// Columns that the terms read, and the rates of density and heat that they write.
    pub fn access(&self, sim: &SimBuilder<'_>, phase: PhaseId) -> Vec<Access> {
        let written = [DensityRate::NAME, ViscousPower::NAME].into_iter();
        let written = written.filter(|name| sim.columns(phase).get(name).is_some());
        let mut access: Vec<Access> = written.map(|column| Access { column, mode: Mode::Writes }).collect();
        for read in self.terms.iter().flat_map(|term| term.term.access()) {
            if !access.contains(&read) {
                access.push(read);
            }
        }
        access
    }

    /// Whether a body has terms.
    pub fn act_on(&self, id: BodyId) -> bool {
        self.bodies.contains(id)
    }

    /// Whether a body has a term that changes its density.
    pub fn change_density_of(&self, id: BodyId) -> bool {
        self.of_changing_density.contains(id)
    }

    /// The bodies that have terms.
    pub fn bodies(&self) -> Vec<BodyId> {
        self.bodies.iter().collect()
    }

    /// Binds the terms of a body and calls `run` with them, with the rows that they write, and with scratch
    /// memory for the largest rates of all blocks of these, which it returns. Without terms nothing is
    /// called.
    pub fn on_body(
        &mut self,
        step: &Step<'_>,
        id: BodyId,
        force: &mut [Force],
        run: &mut dyn FnMut(&BoundTerms<'_>, TermRows<'_>, &mut Vec<RateBounds>) -> RateBounds,
    ) -> Result<RateBounds, StepError> {
        let mut fastest = RateBounds::default();
        let mut bodies = step.resources.of_mut(self.forces);
        let body = bodies.iter_mut().find(|body| body.id == id);
        let Some(BodyTerms { terms: indices, forces, .. }) = body else { return Ok(fastest) };
        let Some(&first) = indices.first() else { return Ok(fastest) };
        let mut slots = [&*self.terms[first].term; MAX_TERMS];
        slots.iter_mut().zip(indices.iter()).for_each(|(slot, &k)| *slot = &*self.terms[k].term);
        let terms = &slots[..indices.len()];
        let (view, rows) = step.world.body_view(id);
        let mut density =
            if view.has::<DensityRate>() { Some(view.write_own::<DensityRate>()?) } else { None };
        let (mut heat, mut volume) = (None, None);
        if view.has::<ViscousPower>() {
            heat = Some(view.write_own::<ViscousPower>()?);
            volume = Some(view.read_own::<ReferenceVolume>()?);
        }
        forces.resize(rows.len() * terms.len(), DVec3::ZERO);
        let plane = step.world.dimension() == Dimension::Two;
        let (sums, reads) = (&mut self.sums, self.reads);
        bind_all(terms, &view, None, &mut |chain| {
            let written = TermRows {
                total: &mut *force,
                by_term: forces,
                terms: terms.len(),
                density: density.as_mut().map_or(&mut [], |density| &mut density[rows.clone()]),
                heat: heat.as_mut().map_or(&mut [], |heat| &mut heat[rows.clone()]),
                volume: volume.as_ref().map_or(&[], |volume| &volume[rows.clone()]),
            };
            fastest = run(&BoundTerms { chain, reads, plane }, written, sums);
        })?;
        Ok(fastest)
    }
}

/// The terms of a body, bound to the columns of its phase.
#[derive(Clone, Copy)]
pub(crate) struct BoundTerms<'a> {
    chain: &'a Chain<'a>,
    /// Reads of the terms of the phase from the pairs.
    pub reads: PairReads,
    plane: bool,
}

impl BoundTerms<'_> {
    /// Runs all terms on the rows of a batch, of particle `first` of the phase and those after it, and writes
    /// the results into a block from row `k` on. Returns the largest rates.
    pub fn run(&self, first: usize, batch: &PairBatch, k: usize, block: &mut TermRows<'_>) -> RateBounds {
        let rows = batch.rows();
        let density = if block.density.is_empty() { &mut [] } else { &mut block.density[k..k + rows] };
        density.fill(DensityRate(0.0));
        let heat = if block.heat.is_empty() { &mut [] } else { &mut block.heat[k..k + rows] };
        heat.fill(ViscousPower(0.0));
        let mut fastest = [RateBounds::default(); MAX_ROWS];
        let out = RowsOut {
            by_term: &mut block.by_term[k * block.terms..(k + rows) * block.terms],
            term: block.terms - 1,
            terms: block.terms,
            total: &mut block.total[k..k + rows],
            density,
            heat: &mut *heat,
            fastest: &mut fastest,
        };
        self.chain.rows(first, batch, self.plane, out);
        for (heat, volume) in heat.iter_mut().zip(block.volume.iter().skip(k)) {
            heat.0 /= volume.0;
        }
        let mut largest = RateBounds::default();
        fastest.iter().for_each(|of_row| largest.add(of_row));
        largest
    }
}

/// The sums of all terms over the neighbours of a block.
pub(crate) type AllSums = [TermSums; MAX_TERMS];

impl BoundTerms<'_> {
    /// Runs all terms on some neighbours of a block of particles, and adds the results to `sums`.
    #[inline]
    pub fn run_block(&self, pairs: &BlockPairs, sums: &mut [TermSums]) {
        self.chain.block(pairs, self.plane, sums);
    }
}

/// Output of the terms for a block: the total force, to which they add, and that of every term.
pub(crate) struct TermRows<'a> {
    pub total: &'a mut [Force],
    by_term: &'a mut [DVec3],
    terms: usize,
    /// Density rates; empty where the phase has none.
    density: &'a mut [DensityRate],
    /// Power of heat; empty where the phase has none.
    heat: &'a mut [ViscousPower],
    /// Reference volumes V_0, m3.
    volume: &'a [ReferenceVolume],
}

impl<'a> TermRows<'a> {
    /// Number of terms.
    #[inline]
    pub fn terms(&self) -> usize {
        self.terms
    }

    /// Writes the force of a term on row `k`, N, and adds it to the total.
    #[inline]
    pub fn put_force(&mut self, k: usize, term: usize, force: DVec3) {
        self.by_term[self.terms * k + term] = force;
        self.total[k].0 += force;
    }

    /// Writes the density rate of row `k`, kg/(m3 s), where the phase has one.
    #[inline]
    pub fn put_density(&mut self, k: usize, rate: f64) {
        if let Some(density) = self.density.get_mut(k) {
            density.0 = rate;
        }
    }

    /// Rows of bodies without terms.
    pub fn without_terms(total: &'a mut [Force]) -> Self {
        Self { total, by_term: &mut [], terms: 0, density: &mut [], heat: &mut [], volume: &[] }
    }
}

impl Split for TermRows<'_> {
    fn rows(&self) -> usize {
        self.total.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let terms = self.terms;
        let (total, total_rest) = self.total.split_at_mut(at);
        let (by_term, by_term_rest) = self.by_term.split_at_mut(at * terms);
        let (density, density_rest) = self.density.split_at_mut(at.min(self.density.len()));
        let (heat, heat_rest) = self.heat.split_at_mut(at.min(self.heat.len()));
        let (volume, volume_rest) = self.volume.split_at(at.min(self.volume.len()));
        let rest = Self {
            total: total_rest,
            by_term: by_term_rest,
            terms,
            density: density_rest,
            heat: heat_rest,
            volume: volume_rest,
        };
        (Self { total, by_term, terms, density, heat, volume }, rest)
    }
}
