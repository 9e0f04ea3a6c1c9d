//! Which of the particles near the box of a block are near one of its particles: where particles are in
//! disorder, half of them are not.

use super::record::{OwnBlock, Packed, dot};
use super::table::BlockTable;
use crate::parallel::{BlockLoop, EightLanes, Lanes8, run_blocks_on};

/// Distances of fluid particles from those of blocks.
#[derive(Clone, Copy)]
pub struct NearTest<'a> {
    pub table: &'a BlockTable,
    /// Places of the fluid particles.
    pub packed: &'a [Packed],
    /// Units of place, m.
    pub unit: [f64; 3],
    /// Square of the distance of near particles, m2.
    pub limit: f64,
    /// Whether all particles have one z.
    pub plane: bool,
}

/// The test for one block.
pub struct NearBlock<'a> {
    packed: &'a [Packed],
    own: OwnBlock,
    unit: [Lanes8; 3],
    limit: Lanes8,
}

impl<'a> NearTest<'a> {
    #[inline(always)]
    pub fn of_block<A: EightLanes>(&self, a: A, block: usize) -> NearBlock<'a> {
        let &Self { table, packed, unit, limit, .. } = self;
        let unit = [a.splat(unit[0]), a.splat(unit[1]), a.splat(unit[2])];
        NearBlock { packed, own: OwnBlock::new(packed, &table.rows[block]), unit, limit: a.splat(limit) }
    }

    /// Keeps, in the concatenated rows of the blocks from `first` on, those that are near.
    pub fn sift(self, first: usize, ends: &mut [usize], found: &mut [u32]) {
        run_blocks_on(self.plane, SiftLoop { test: self, first, ends, found });
    }
}

impl NearBlock<'_> {
    /// The bits of the particles of the block that are near a fluid particle.
    #[inline(always)]
    pub fn bits<A: EightLanes>(&self, a: A, j: u32) -> usize {
        let x = self.own.to(a, &self.packed[j as usize], &self.unit).x;
        a.below(dot(a, &x, &x), self.limit)
    }
}

struct SiftLoop<'a> {
    test: NearTest<'a>,
    first: usize,
    ends: &'a mut [usize],
    found: &'a mut [u32],
}

impl BlockLoop for SiftLoop<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        let Self { test, first, ends, found } = self;
        let (mut start, mut kept) = (0, 0);
        for (k, end) in ends.iter_mut().enumerate() {
            let near = test.of_block(a, first + k);
            for n in start..*end {
                let j = found[n];
                found[kept] = j;
                kept += usize::from(near.bits(a, j) != 0);
            }
            start = *end;
            *end = kept;
        }
    }
}
