//! Second pass over pairs, in blocks: the force of pressure and viscosity (`passes::pair_force`), and the pair terms of plugins.

use std::cell::RefCell;

use super::super::pair_force::ForceRows;
use super::land::{Landing, land};
use super::pairs::{BlockForces, PairsOfBlock, hide};
use crate::formulations::fluid::cloud::{FlowCloud, Group, take_until};
use crate::formulations::fluid::lanes::{KernelLoop, PairShape};
use crate::formulations::fluid::lists::blocks::{Blocks, OwnBlock, Packed};
use crate::pair::{AllSums, BlockPairs, BoundTerms, CHUNK, PhaseTerms, RateBounds, TermRows, TermSums};
use crate::parallel::{BlockLoop, EightLanes, Split, for_each_own_block_in_tasks, run_blocks_on};
use crate::schedule::{Step, StepError};
use crate::world::Force;
use glam::DVec3;

thread_local! {
    /// The pairs of a block with some neighbours; kept, so that it is not allocated for every task.
    static PAIRS: RefCell<BlockPairs> = const { RefCell::new(BlockPairs::EMPTY) };
}

/// Tasks of 512 particles are worth handing over to another thread.
const PER_TASK: usize = 8;

/// The pass over the particles of a body.
pub struct BlockForce<'a> {
    pub cloud: &'a FlowCloud,
    pub group: &'a Group,
    pub blocks: &'a Blocks,
    /// Whether the force is added to what is there already.
    pub adds: bool,
}

impl BlockForce<'_> {
    /// Writes the forces on the particles that this rank computes, and their parts.
    pub fn run(&self, total: &mut [Force], parts: &mut [DVec3]) {
        self.sum(None, ForceRows { written: TermRows::without_terms(total), parts }, &mut Vec::new());
    }

    /// The same with the pair terms of the body.
    pub fn run_with(
        &self,
        terms: &mut PhaseTerms,
        step: &mut Step<'_>,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) -> Result<(), StepError> {
        let body = self.group.body;
        let fastest = terms.on_body(step, body, total, &mut |terms, written, sums| {
            self.sum(Some(terms), ForceRows { written, parts: &mut *parts }, sums)
        })?;
        fastest.limit(step, body);
        Ok(())
    }

    fn sum(
        &self,
        terms: Option<&BoundTerms<'_>>,
        rows: ForceRows<'_>,
        sums: &mut Vec<RateBounds>,
    ) -> RateBounds {
        self.cloud.kernel.run(AllForceBlocks { pass: self, terms, rows, sums })
    }
}

struct AllForceBlocks<'a> {
    pass: &'a BlockForce<'a>,
    terms: Option<&'a BoundTerms<'a>>,
    rows: ForceRows<'a>,
    sums: &'a mut Vec<RateBounds>,
}

impl KernelLoop for AllForceBlocks<'_> {
    type Output = RateBounds;

    fn run<K: PairShape>(self, kernel: K) -> RateBounds {
        let Self { pass, terms, rows, sums } = self;
        for_each_own_block_in_tasks(PER_TASK, rows, sums, &|row, rows| {
            PAIRS.with_borrow_mut(|pairs| {
                let first = pass.group.cloud.start + row;
                run_blocks_on(pass.cloud.plane, ForceBlocks { pass, terms, kernel, first, rows, pairs })
            })
        })
    }
}

struct ForceBlocks<'a, K> {
    pass: &'a BlockForce<'a>,
    terms: Option<&'a BoundTerms<'a>>,
    kernel: K,
    /// First row in the cloud.
    first: usize,
    rows: ForceRows<'a>,
    pairs: &'a mut BlockPairs,
}

impl<K: PairShape> BlockLoop for ForceBlocks<'_, K> {
    type Output = RateBounds;

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) -> RateBounds {
        let Self { pass: BlockForce { cloud, group, blocks, adds }, terms, kernel, first, mut rows, pairs } =
            self;
        let Blocks { lists, units, packed, near, hides } = blocks;
        let count = rows.written.terms();
        let packed: &[Packed] = packed;
        let (groups, viscosities) = (&cloud.groups[..], cloud.viscosities.of(group));
        let factor = cloud.viscosities.factor();
        let flows = group.fluid().is_some();
        let mut fastest = RateBounds::default();
        let mut of_terms: AllSums = Default::default();
        for block in lists.table.of_rows(&(first..first + rows.rows())) {
            let particles = &lists.table.rows[block];
            let own = OwnBlock::new(packed, particles);
            let mut of_block = PairsOfBlock::new(a, (packed, kernel, units), own, cloud, particles);
            pairs.begin(*particles, own.volume, cloud.kernel.support);
            of_terms[..count].fill(TermSums::default());
            let mut sums = BlockForces::ZERO;
            let mut rest = near.row(block);
            let mut seen = if *hides { near.lanes(block) } else { &[] };
            // By number: zipped iterators would be called.
            for n in 0..groups.len() {
                if rest.is_empty() {
                    break;
                }
                let other = &groups[n];
                let row = take_until(&mut rest, other.cloud.end);
                of_block.viscosity = factor * viscosities[n];
                let terms = terms.filter(|_| other.cloud.start == group.cloud.start);
                for chunk in row.chunks(CHUNK) {
                    of_block.fill(a, chunk, terms.is_some_and(|terms| terms.reads.kernel), pairs);
                    if *hides {
                        let (of_chunk, others) = seen.split_at(chunk.len());
                        hide(a, of_chunk, pairs);
                        seen = others;
                    }
                    match (flows, other.fluid().is_some()) {
                        (true, true) => of_block.add_fluid(a, pairs, &mut sums),
                        (true, false) => of_block.add_walls::<A, false>(a, pairs, &mut sums),
                        (false, _) => of_block.add_walls::<A, true>(a, pairs, &mut sums),
                    }
                    if let Some(terms) = terms {
                        terms.run_block(pairs, &mut of_terms[..count]);
                    }
                }
            }
            let of_terms = &of_terms[..count];
            land(&sums, of_terms, Landing { particles, first, plane: cloud.plane, adds: *adds }, &mut rows);
            if count > 0 {
                fastest.add_block(of_terms);
            }
        }
        fastest
    }
}
