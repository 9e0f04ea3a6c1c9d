//! Second pass over pairs, in blocks: the force of pressure and viscosity (`passes::pair_force`), and the
//! pair terms of plugins.

use std::cell::RefCell;

use super::super::pair_force::ForceRows;
use super::super::pair_sums::Between;
use super::land::{BlockOutput, land};
use super::pairs::{BlockForces, Chunk, PairsOfBlock};
use crate::formulations::fluid::cloud::{FlowCloud, Group, take_until};
use crate::formulations::fluid::lanes::{KernelLoop, PairShape};
use crate::formulations::fluid::lists::blocks::Blocks;
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
    /// Whether the force is added to the present values.
    pub adds: bool,
}

impl BlockForce<'_> {
    /// Writes the forces on the particles that this rank computes, and their parts.
    pub fn run(&self, total: &mut [Force], parts: &mut [DVec3]) {
        self.sum(None, ForceRows { written: TermRows::without_terms(total), parts }, None);
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
            self.sum(Some(terms), ForceRows { written, parts: &mut *parts }, Some(sums))
        })?;
        fastest.limit(step, body);
        Ok(())
    }

    fn sum(
        &self,
        terms: Option<&BoundTerms<'_>>,
        rows: ForceRows<'_>,
        sums: Option<&mut Vec<RateBounds>>,
    ) -> RateBounds {
        self.cloud.kernel.run(AllForceBlocks { pass: self, terms, rows, sums })
    }
}

struct AllForceBlocks<'a> {
    pass: &'a BlockForce<'a>,
    terms: Option<&'a BoundTerms<'a>>,
    rows: ForceRows<'a>,
    /// Memory that is kept for the results of the terms of each block.
    sums: Option<&'a mut Vec<RateBounds>>,
}

impl KernelLoop for AllForceBlocks<'_> {
    type Output = RateBounds;

    fn run<K: PairShape>(self, kernel: K) -> RateBounds {
        let Self { pass, terms, rows, sums } = self;
        let blocks = |row, rows| {
            PAIRS.with_borrow_mut(|pairs| {
                let first = pass.group.cloud.start + row;
                run_blocks_on(pass.cloud.plane, ForceBlocks { pass, terms, kernel, first, rows, pairs })
            })
        };
        match sums {
            Some(sums) => for_each_own_block_in_tasks(PER_TASK, rows, sums, &blocks),
            None => {
                for_each_own_block_in_tasks(PER_TASK, rows, &mut Vec::new(), &|row, rows| {
                    blocks(row, rows);
                });
                RateBounds::default()
            }
        }
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
        let Blocks { lists, near, hides, .. } = blocks;
        let count = rows.written.terms();
        let (groups, viscosities) = (&cloud.groups[..], cloud.viscosities.of(group));
        let factor = cloud.viscosities.factor();
        let flows = group.fluid().is_some();
        let mut fastest = RateBounds::default();
        let mut of_terms: AllSums = Default::default();
        for block in lists.table.of_rows(&(first..first + rows.rows())) {
            let particles = &lists.table.rows[block];
            let mut of_block = PairsOfBlock::new(a, blocks, kernel, cloud, particles);
            pairs.begin(*particles, of_block.own.volume, cloud.kernel.support);
            of_terms[..count].fill(TermSums::default());
            let mut sums = BlockForces::ZERO;
            let mut rest = near.row(block);
            let mut seen = hides.then(|| near.lanes(block));
            // By number: zipped iterators would be called.
            for n in 0..groups.len() {
                if rest.is_empty() {
                    break;
                }
                let other = &groups[n];
                let row = take_until(&mut rest, other.cloud.end);
                of_block.viscosity = factor * viscosities[n];
                let between = Between::of(flows, other.fluid().is_some());
                let terms = terms.filter(|_| other.cloud.start == group.cloud.start);
                for chunk in row.chunks(CHUNK) {
                    let of_chunk = take_bits(&mut seen, chunk.len());
                    let chunk = Chunk { row: chunk, seen: of_chunk, between };
                    let kept = terms.map(|_| pairs.slots(chunk.row.len()));
                    of_block.add(a, chunk, kept, &mut sums);
                    if let Some(terms) = terms {
                        if terms.reads.kernel {
                            of_block.add_kernel(a, pairs.pairs_mut());
                        }
                        terms.run_block(pairs, &mut of_terms[..count]);
                    }
                }
            }
            let of_terms = &of_terms[..count];
            land(
                &sums,
                of_terms,
                BlockOutput { particles, first, plane: cloud.plane, adds: *adds },
                &mut rows,
            );
            if count > 0 {
                fastest.add_block(of_terms);
            }
        }
        fastest
    }
}

/// Takes the bits of that many neighbours out of those that are left.
#[inline(always)]
fn take_bits<'a>(rest: &mut Option<&'a [u8]>, count: usize) -> Option<&'a [u8]> {
    let (bits, behind) = (*rest)?.split_at(count);
    *rest = Some(behind);
    Some(bits)
}
