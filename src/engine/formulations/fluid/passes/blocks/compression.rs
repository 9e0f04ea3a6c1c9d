//! First pass over pairs, in blocks: the neighbours within the support, and the rate of compression
//! (`passes::compression`).

use std::ops::Range;

use crate::formulations::fluid::cloud::FlowCloud;
use crate::formulations::fluid::lanes::{KernelLoop, PairShape};
use crate::formulations::fluid::lists::blocks::{BlockLists, Blocks, OfBlocks, OwnBlock, Packed, SEEN, dot};
use crate::formulations::fluid::lists::{NearRow, NearWriter};
use crate::parallel::{
    BlockLoop, EIGHT, EightLanes, Lanes8, Split, for_each_own_block, others_rows, run_blocks_on,
    share_rows_of,
};

impl FlowCloud {
    /// Finds the neighbours within the support of every block, and D of every fluid particle, 1/s, in a step
    /// of that length, s.
    pub(in crate::formulations::fluid) fn compress_blocks(&mut self, blocks: &mut Blocks, dt: f64) {
        let Blocks { lists, units, packed, near, hides } = blocks;
        let (mut rates, mut is_close) =
            (std::mem::take(&mut self.compression), std::mem::take(&mut self.is_close));
        rates.resize(self.fluid, 0.0);
        is_close.resize(self.fluid, 0);
        let pass = Compress {
            packed,
            lists,
            unit: units.length.to_array(),
            back: -0.5 * dt,
            range: self.repulsion_range * self.repulsion_range,
            limit: self.kernel.support * self.kernel.support,
            least: self.kernel.min_square(),
            scale: self.kernel.weight_scale(),
            plane: self.plane,
        };
        let (rows, near_rows) = ((&mut rates[..], &mut is_close[..]), near.writer());
        if *hides {
            self.kernel.run(AllCompressionBlocks::<true, _> { pass, fluids: self.fluids(), rows, near_rows });
        } else {
            self.kernel.run(AllCompressionBlocks::<false, _> {
                pass,
                fluids: self.fluids(),
                rows,
                near_rows,
            });
        }
        if !self.is_local() {
            share_rows_of(&mut rates, self.fluids());
            share_rows_of(&mut is_close, self.fluids());
        }
        if *hides {
            let others = self.fluids().flat_map(|fluid| others_rows(&fluid));
            near.fill_others(others.map(|rows| lists.table.of_rows(&rows)), |block| {
                let seen = lists.seen(block);
                [(lists.fluid.row(block), seen.0), (lists.walls.row(block), seen.1)]
            });
        }
        (self.compression, self.is_close) = (rates, is_close);
        if blocks.hides {
            self.pack_rows(blocks);
        }
    }
}

/// The bits of all particles of a block.
const ALL: u8 = u8::MAX;

/// Input of the pass.
#[derive(Clone, Copy)]
struct Compress<'a> {
    packed: &'a [Packed],
    lists: &'a BlockLists,
    /// Units of place, m.
    unit: [f64; 3],
    /// Time from the end of the step to its middle, s.
    back: f64,
    /// Squares of the range of repulsion, of the support radius, and of the distance of particles in one
    /// place, m2.
    range: f64,
    limit: f64,
    least: f64,
    /// Weight at r = 0.
    scale: f64,
    plane: bool,
}

/// `HIDDEN`: where some particles do not see all near ones; those that do have a bit each.
struct AllCompressionBlocks<'a, const HIDDEN: bool, F> {
    pass: Compress<'a>,
    fluids: F,
    rows: (&'a mut [f64], &'a mut [u8]),
    near_rows: NearWriter<'a>,
}

/// Rates of compression of some particles, whether each is close to a boundary, and the neighbours of their
/// blocks.
type BlockRows<'a> = (&'a mut [f64], &'a mut [u8], OfBlocks<'a, NearWriter<'a>>);

impl<const HIDDEN: bool, F: Iterator<Item = Range<usize>>> KernelLoop
    for AllCompressionBlocks<'_, HIDDEN, F>
{
    type Output = ();

    fn run<K: PairShape>(self, kernel: K) {
        let Self { pass, fluids, mut rows, mut near_rows } = self;
        let table = &pass.lists.table;
        for fluid in fluids {
            let ((rates, close), behind) = rows.split(fluid.len());
            rows = behind;
            let (near, behind) = near_rows.split(table.of_rows(&fluid).len());
            near_rows = behind;
            let rows = (rates, close, table.beside(&fluid, near));
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
        let Self { pass, kernel, first, rows: (rates, is_close, near) } = self;
        let Compress { packed, lists, unit, back, range, limit, least: smallest, scale, .. } = pass;
        let mut writer = near.blocks;
        let unit = [a.splat(unit[0]), a.splat(unit[1]), a.splat(unit[2])];
        let (back, limit, smallest) = (a.splat(back), a.splat(limit), a.splat(smallest));
        for (k, block) in lists.table.of_rows(&(first..first + rates.len())).enumerate() {
            let rows = &lists.table.rows[block];
            let mut near = writer.row(k);
            let mut least = a.splat(f64::INFINITY);
            let own = OwnBlock::new(packed, rows);
            let mut sums = RateSums { packed, kernel, own, unit, back, limit, smallest, sum: Lanes8::ZERO };
            let (fluid, walls) = (lists.fluid.row(block), lists.walls.row(block));
            if HIDDEN {
                let (seen, seen_walls) = lists.seen(block);
                for (&j, &seen) in fluid.iter().zip(seen) {
                    sums.add::<A, HIDDEN>(a, j, seen, &mut near);
                }
                for (&j, &seen) in walls.iter().zip(seen_walls) {
                    least = a.min(sums.add::<A, HIDDEN>(a, j, seen, &mut near), least);
                }
            } else {
                for &j in fluid {
                    sums.add::<A, HIDDEN>(a, j, ALL, &mut near);
                }
                for &j in walls {
                    least = a.min(sums.add::<A, HIDDEN>(a, j, ALL, &mut near), least);
                }
            }
            near.close();
            let close = a.below(least, a.splat(range));
            for lane in 0..EIGHT {
                let row = rows[lane] as usize - first;
                rates[row] = scale * f64::from(sums.sum.0[lane]);
                is_close[row] = (close >> lane & 1) as u8;
            }
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
    /// Adds a neighbour with the bits of those who see it; gives the squares of the distances at the end of
    /// the step, and writes it down where one is within the support.
    #[inline(always)]
    fn add<A: EightLanes, const HIDDEN: bool>(
        &mut self,
        a: A,
        j: u32,
        seen: u8,
        near: &mut NearRow<'_>,
    ) -> Lanes8 {
        let other = &self.packed[j as usize];
        let pair = self.own.to(a, other, &self.unit);
        let square = dot(a, &pair.x, &pair.x);
        near.push_if::<HIDDEN>(j, a.below(square, self.limit) & usize::from(seen));
        let mut x = pair.x;
        for axis in 0..A::AXES {
            x[axis] = a.mul_add(pair.v[axis], self.back, x[axis]);
        }
        let distance = a.sqrt(a.max(dot(a, &x, &x), self.smallest));
        let mut volume = a.same(other.volume);
        if HIDDEN {
            volume = a.mul(volume, SEEN[usize::from(seen)]);
        }
        let approach = a.mul(dot(a, &pair.v, &x), volume);
        self.sum = a.mul_add(self.kernel.shape(a, distance), approach, self.sum);
        square
    }
}
