//! Second pass over pairs, in blocks: the force of pressure and viscosity (`passes::pair_force`), and the pair terms of plugins.

use std::cell::RefCell;

use super::land::{FIXED, Landing, stride};
use super::pairs::{BlockForces, PairsOfBlock, hide};
use crate::formulations::fluid::cloud::{FlowCloud, Group, take_until};
use crate::formulations::fluid::lanes::{KernelLoop, PairShape};
use crate::formulations::fluid::lists::blocks::{BlockSums, Blocks, OwnBlock, Packed};
use crate::pair::{AllSums, BlockPairs, BoundTerms, CHUNK, PhaseTerms, RateBounds, TermRows, TermSums};
use crate::parallel::{BlockLoop, EightLanes, Lanes8, for_each_own_block_in_tasks, run_blocks_on};
use crate::schedule::{Step, StepError};
use crate::world::Force;
use glam::DVec3;

thread_local! {
    /// The pairs of a block with some neighbours; kept, so that it is not allocated for every task.
    static PAIRS: RefCell<BlockPairs> = const { RefCell::new(BlockPairs::EMPTY) };
}

/// Tasks of 64 blocks are worth handing over to another thread.
const PER_TASK: usize = 1;

/// The pass over the particles of the fluid of that number.
pub struct BlockForce<'a> {
    pub cloud: &'a FlowCloud,
    pub group: &'a Group,
    pub number: usize,
    pub blocks: &'a mut Blocks,
}

impl BlockForce<'_> {
    /// Writes the forces on all particles of the fluid and their parts.
    pub fn run(&mut self, total: &mut [Force], parts: &mut [DVec3]) {
        self.sum(None, 0);
        self.land(TermRows::without_terms(total), parts);
    }

    /// The same with the pair terms of the body.
    pub fn run_with(
        &mut self,
        terms: &mut PhaseTerms,
        step: &mut Step<'_>,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) -> Result<(), StepError> {
        let body = self.group.body;
        let fastest = terms.on_body(step, body, total, &mut |terms, written, _| {
            let fastest = self.sum(Some(terms), written.terms());
            self.land(written, parts);
            fastest
        })?;
        fastest.limit(step, body);
        Ok(())
    }

    fn sum(&mut self, terms: Option<&BoundTerms<'_>>, count: usize) -> RateBounds {
        let range = self.blocks.lists.table.of_fluid(self.number);
        let stride = stride(count);
        let Blocks { forces, fastest, .. } = &mut *self.blocks;
        let (mut forces, mut sums) = (std::mem::take(forces), std::mem::take(fastest));
        forces.resize(range.len() * stride, Lanes8::ZERO);
        let pass = Pass { cloud: self.cloud, group: self.group, blocks: self.blocks, terms, count };
        let rows = BlockSums { lanes: &mut forces, stride };
        let fastest =
            self.cloud.kernel.run(AllForceBlocks { pass, first: range.start, rows, sums: &mut sums });
        self.blocks.make_halo(self.number, &self.group.cloud);
        let halo = &self.blocks.halos[self.number];
        halo.fill_bytes(bytemuck::cast_slice_mut(&mut forces), stride * size_of::<Lanes8>());
        (self.blocks.forces, self.blocks.fastest) = (forces, sums);
        fastest
    }

    fn land(&self, written: TermRows<'_>, parts: &mut [DVec3]) {
        let Blocks { lists, forces, .. } = &*self.blocks;
        let first = lists.table.of_fluid(self.number).start;
        let first_row = self.group.cloud.start;
        let plane = self.cloud.plane;
        Landing { table: &lists.table, first_block: first, first_row, forces, plane }.run(written, parts);
    }
}

/// What the pass reads.
struct Pass<'a> {
    cloud: &'a FlowCloud,
    group: &'a Group,
    blocks: &'a Blocks,
    terms: Option<&'a BoundTerms<'a>>,
    count: usize,
}

struct AllForceBlocks<'a> {
    pass: Pass<'a>,
    first: usize,
    rows: BlockSums<'a>,
    sums: &'a mut Vec<RateBounds>,
}

impl KernelLoop for AllForceBlocks<'_> {
    type Output = RateBounds;

    fn run<K: PairShape>(self, kernel: K) -> RateBounds {
        let Self { pass, first, rows, sums } = self;
        for_each_own_block_in_tasks(PER_TASK, rows, sums, &|row, rows| {
            PAIRS.with_borrow_mut(|pairs| {
                let first = first + row;
                run_blocks_on(pass.cloud.plane, ForceBlocks { pass: &pass, kernel, first, rows, pairs })
            })
        })
    }
}

struct ForceBlocks<'a, K> {
    pass: &'a Pass<'a>,
    kernel: K,
    first: usize,
    rows: BlockSums<'a>,
    pairs: &'a mut BlockPairs,
}

impl<K: PairShape> BlockLoop for ForceBlocks<'_, K> {
    type Output = RateBounds;

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) -> RateBounds {
        let Self { pass, kernel, first, rows: BlockSums { lanes, stride }, pairs } = self;
        let Pass { cloud, group, blocks, terms, count } = *pass;
        let Blocks { lists, units, packed, near, hides, .. } = blocks;
        let packed: &[Packed] = packed;
        let (groups, viscosities) = (&cloud.groups[..], cloud.viscosities.of(group));
        let factor = cloud.viscosities.factor();
        let mut fastest = RateBounds::default();
        let mut of_terms: AllSums = Default::default();
        for k in 0..lanes.len() / stride {
            let rows = &lists.table.rows[first + k];
            let own = OwnBlock::new(packed, rows);
            let mut of_block = PairsOfBlock::new(a, (packed, kernel, units), own, cloud, rows);
            pairs.begin(*rows, own.volume, cloud.kernel.support);
            of_terms[..count].fill(TermSums::default());
            let mut sums = BlockForces::ZERO;
            let mut rest = near.row(first + k);
            let mut seen = if *hides { near.lanes(first + k) } else { &[] };
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
                    if other.fluid().is_some() {
                        of_block.add_fluid(a, pairs, &mut sums);
                    } else {
                        of_block.add_walls(a, pairs, &mut sums);
                    }
                    if let Some(terms) = terms {
                        terms.run_block(pairs, &mut of_terms[..count]);
                    }
                }
            }
            let out = &mut lanes[k * stride..(k + 1) * stride];
            out[..3].copy_from_slice(&sums.pressure);
            out[3..6].copy_from_slice(&sums.viscous);
            out[6..FIXED].copy_from_slice(&sums.wall);
            let mut density = Lanes8::ZERO;
            for (n, term) in of_terms[..count].iter().enumerate() {
                out[FIXED + 3 * n..FIXED + 3 * (n + 1)].copy_from_slice(&term.force);
                density = a.plus(density, term.density);
            }
            if count > 0 {
                out[stride - 1] = density;
                fastest.add_block(&of_terms[..count]);
            }
        }
        fastest
    }
}
