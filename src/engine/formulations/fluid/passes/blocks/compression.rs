//! First pass over pairs, in blocks: who is within the support, and the rate of compression (`passes::compression`).

use crate::formulations::fluid::cloud::FlowCloud;
use crate::formulations::fluid::lanes::{KernelLoop, PairShape};
use crate::formulations::fluid::lists::blocks::{BlockLists, Blocks, OwnBlock, Packed, SEEN, dot, pack};
use crate::formulations::fluid::lists::{NearRow, NearWriter};
use crate::parallel::{
    BlockLoop, EightLanes, Lanes8, Split, for_each_block, for_each_own_block, run_blocks_on, share_rows_of,
};

impl FlowCloud {
    /// Finds the neighbours within the support of every block, and D of every fluid particle, 1/s, in a step of that length, s.
    pub(in crate::formulations::fluid) fn compress_blocks(&mut self, blocks: &mut Blocks, dt: f64) {
        let Blocks { lists, units, packed, near, rates, close, hides, .. } = blocks;
        pack(packed, &self.records, units);
        rates.resize(lists.table.rows.len(), Lanes8::ZERO);
        close.resize(lists.table.rows.len(), 0);
        let pass = Compress {
            packed,
            lists,
            unit: units.length.to_array(),
            back: -0.5 * dt,
            reach: self.reach * self.reach,
            limit: self.kernel.support * self.kernel.support,
            least: self.kernel.least_square(),
            plane: self.plane,
        };
        let rows = (&mut rates[..], &mut close[..], near.writer());
        if *hides {
            self.kernel.run(AllCompressionBlocks::<true> { pass, rows });
        } else {
            self.kernel.run(AllCompressionBlocks::<false> { pass, rows });
        }
        share_rows_of(rates, lists.table.fluids());
        share_rows_of(close, lists.table.fluids());
        near.fill_others(lists.table.fluids(), |block| {
            let seen = if *hides { lists.seen(block) } else { Default::default() };
            [(lists.fluid.row(block), seen.0), (lists.walls.row(block), seen.1)]
        });
        let factor = self.kernel.weight_scale();
        let (rates, close, table) = (&*rates, &*close, &lists.table);
        self.compression.resize(self.fluid, 0.0);
        self.is_close.resize(self.fluid, 0);
        let rows = (&mut self.compression[..], &mut self.is_close[..]);
        for_each_block(rows, &mut Vec::new(), &|first, (rate, is_close): (&mut [f64], &mut [u8])| {
            for (k, (rate, is_close)) in rate.iter_mut().zip(is_close).enumerate() {
                let (block, lane) = table.place(first + k);
                *rate = factor * f64::from(rates[block].0[lane]);
                *is_close = close[block] >> lane & 1;
            }
        });
        if blocks.hides {
            self.pack_rows(blocks);
        }
    }
}

/// The bits of all particles of a block.
const ALL: u8 = u8::MAX;

/// What the pass reads.
#[derive(Clone, Copy)]
struct Compress<'a> {
    packed: &'a [Packed],
    lists: &'a BlockLists,
    /// Units of place, m.
    unit: [f64; 3],
    /// Time from the end of the step to its middle, s.
    back: f64,
    /// Squares of the reach of boundaries, of the support radius, and of the distance of particles in one place, m2.
    reach: f64,
    limit: f64,
    least: f64,
    plane: bool,
}

/// `HIDDEN`: where some particles do not see what is near them; those who do get a bit each.
struct AllCompressionBlocks<'a, const HIDDEN: bool> {
    pass: Compress<'a>,
    rows: BlockRows<'a>,
}

/// Rates of compression, bits of the particles close to a boundary, and neighbours, of some blocks.
type BlockRows<'a> = (&'a mut [Lanes8], &'a mut [u8], NearWriter<'a>);

impl<const HIDDEN: bool> KernelLoop for AllCompressionBlocks<'_, HIDDEN> {
    type Output = ();

    fn run<K: PairShape>(self, kernel: K) {
        let Self { pass, rows } = self;
        let mut rest = rows;
        for fluid in pass.lists.table.fluids() {
            let (rows, behind) = rest.split(fluid.len());
            rest = behind;
            for_each_own_block(rows, &mut Vec::new(), &|first, rows: BlockRows<'_>| {
                let first = fluid.start + first;
                run_blocks_on(pass.plane, CompressionBlocks::<K, HIDDEN> { pass, kernel, first, rows });
            });
        }
    }
}

struct CompressionBlocks<'a, K, const HIDDEN: bool> {
    pass: Compress<'a>,
    kernel: K,
    first: usize,
    rows: BlockRows<'a>,
}

impl<K: PairShape, const HIDDEN: bool> BlockLoop for CompressionBlocks<'_, K, HIDDEN> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        let Self { pass, kernel, first, rows: (rates, close, mut writer) } = self;
        let Compress { packed, lists, unit, back, reach, limit, least: smallest, .. } = pass;
        let unit = [a.splat(unit[0]), a.splat(unit[1]), a.splat(unit[2])];
        let (back, limit, smallest) = (a.splat(back), a.splat(limit), a.splat(smallest));
        for (k, (rate, close)) in rates.iter_mut().zip(close).enumerate() {
            let block = first + k;
            let mut near = writer.row(k);
            let mut least = a.splat(f64::INFINITY);
            let own = OwnBlock::new(packed, &lists.table.rows[block]);
            let mut sums = RateSums { packed, kernel, own, unit, back, limit, smallest, sum: Lanes8::ZERO };
            let (fluid, walls) = (lists.fluid.row(block), lists.walls.row(block));
            if HIDDEN {
                let (seen, seen_walls) = lists.seen(block);
                for (&j, &seen) in fluid.iter().zip(seen) {
                    sums.add::<A, HIDDEN>(a, (j, seen), &mut near);
                }
                for (&j, &seen) in walls.iter().zip(seen_walls) {
                    least = a.smaller(sums.add::<A, HIDDEN>(a, (j, seen), &mut near), least);
                }
            } else {
                for &j in fluid {
                    sums.add::<A, HIDDEN>(a, (j, ALL), &mut near);
                }
                for &j in walls {
                    least = a.smaller(sums.add::<A, HIDDEN>(a, (j, ALL), &mut near), least);
                }
            }
            near.close();
            (*rate, *close) = (sums.sum, a.below(least, a.splat(reach)) as u8);
        }
    }
}

struct RateSums<'a, K> {
    packed: &'a [Packed],
    kernel: K,
    own: OwnBlock,
    unit: [Lanes8; 3],
    back: Lanes8,
    limit: Lanes8,
    smallest: Lanes8,
    sum: Lanes8,
}

impl<K: PairShape> RateSums<'_, K> {
    /// Adds a neighbour with the bits of those who see it; gives the squares of the distances at the end of the step, and writes it down where one is within the support.
    #[inline(always)]
    fn add<A: EightLanes, const HIDDEN: bool>(
        &mut self,
        a: A,
        (j, seen): (u32, u8),
        near: &mut NearRow<'_>,
    ) -> Lanes8 {
        let other = &self.packed[j as usize];
        let pair = self.own.to(a, other, &self.unit);
        let square = dot(a, &pair.x, &pair.x);
        near.push_if::<HIDDEN>(j, a.below(square, self.limit) & usize::from(seen));
        let mut x = pair.x;
        for axis in 0..A::AXES {
            x[axis] = a.times_add(pair.v[axis], self.back, x[axis]);
        }
        let distance = a.sqrt(a.larger(dot(a, &x, &x), self.smallest));
        let mut volume = a.same(other.volume);
        if HIDDEN {
            volume = a.times(volume, SEEN[usize::from(seen)]);
        }
        let approach = a.times(dot(a, &pair.v, &x), volume);
        self.sum = a.times_add(self.kernel.shape(a, distance), approach, self.sum);
        square
    }
}
