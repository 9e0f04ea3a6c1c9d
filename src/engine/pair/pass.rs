//! The pass over pairs that runs the pair terms of a formulation whose own passes do not.

use std::cell::RefCell;
use std::ops::Range;

use super::batch::PairBatch;
use super::of_phase::{BoundTerms, PhaseTerms, TermRows};
use super::rate_bounds::RateBounds;
use super::term::PairReads;
use crate::parallel::{BlockSum, for_each_own_block};
use crate::plugin::{SetupError, SimBuilder};
use crate::schedule::{Access, Run, Stage, Step, StepError, System};
use crate::world::{
    BodyId, Force, PhaseId, Position, ReferencePosition, ReferenceVolume, Removed, SupportRadius, Velocity,
};

thread_local! {
    /// The geometry of some rows; kept, so that a step does not allocate.
    static BATCH: RefCell<PairBatch> = RefCell::default();
}

/// Lends the batch of this thread.
pub(crate) fn with_batch<R>(f: impl FnOnce(&mut PairBatch) -> R) -> R {
    BATCH.with_borrow_mut(f)
}

/// The pairs of one body.
pub trait PairRows: Sync {
    /// Begins a batch and puts in the neighbours of the first of these particles, and of those after it until
    /// it is full, each in the order of its neighbour list.
    fn fill(&self, rows: Range<usize>, batch: &mut PairBatch);
}

/// Storage of the pairs of a formulation.
pub trait PairSource: Send + 'static {
    /// Calls `run` with the pairs of a body, whose kernel values and velocities are there if they are read.
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        reads: PairReads,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError>;

    /// Access beyond the columns that every pass over pairs reads.
    fn access(&self) -> Vec<Access> {
        Vec::new()
    }
}

/// Takes the pair terms of the bodies of a phase out of the builder, and adds the pass that runs them after
/// the systems that write the force, and the booking of their work. Without terms nothing is added.
pub fn add_pair_systems(
    sim: &mut SimBuilder<'_>,
    phase: PhaseId,
    source: impl PairSource,
) -> Result<(), SetupError> {
    add_present_pair_systems(sim, phase, source).map(|_| ())
}

/// The same; returns whether there are terms.
pub(crate) fn add_present_pair_systems(
    sim: &mut SimBuilder<'_>,
    phase: PhaseId,
    source: impl PairSource,
) -> Result<bool, SetupError> {
    let Some(terms) = PhaseTerms::take(sim, phase)? else { return Ok(false) };
    let bodies = terms.bodies();
    let (access, of_source, reads) = (terms.access(sim, phase), source.access(), terms.reads);
    let pass = PairPass { phase, source, terms, bodies };
    let system = System::new(Stage::Rates, "pair_terms", pass)
        .on_phases([phase])
        .reads_near::<Position>()
        .reads_near::<ReferencePosition>()
        .reads_near::<ReferenceVolume>()
        .reads_near::<Removed>()
        .reads_near::<SupportRadius>()
        .adds::<Force>()
        .touches_all(of_source)
        .touches_all(access);
    sim.add_system(if reads.velocity { system.reads_near::<Velocity>() } else { system });
    Ok(true)
}

/// The pass over all pairs of a phase.
struct PairPass<S> {
    phase: PhaseId,
    source: S,
    terms: PhaseTerms,
    bodies: Vec<BodyId>,
}

impl<S: PairSource> Run for PairPass<S> {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let mut force = view.write_own::<Force>()?;
        for &id in &self.bodies {
            let rows = step.world.body(id).rows.clone();
            let (source, terms) = (&self.source, &mut self.terms);
            let mut fastest = RateBounds::default();
            source.with_rows(step, id, terms.reads, &mut |pairs| {
                let total = &mut force[rows.clone()];
                fastest = terms.on_body(step, id, total, &mut |terms, written, sums| {
                    for_each_own_block(written, sums, &|first, block| {
                        run_block(terms, pairs, rows.start + first, block)
                    })
                })?;
                Ok(())
            })?;
            fastest.limit(step, id);
        }
        Ok(())
    }
}

fn run_block(
    terms: &BoundTerms<'_>,
    pairs: &dyn PairRows,
    first: usize,
    mut block: TermRows<'_>,
) -> RateBounds {
    let mut fastest = RateBounds::default();
    let rows = block.total.len();
    with_batch(|batch| {
        let mut done = 0;
        while done < rows {
            pairs.fill(first + done..first + rows, batch);
            fastest.add(&terms.run(first + done, batch, done, &mut block));
            done += batch.rows();
        }
    });
    fastest
}
