//! Which particles of a block see a neighbour, a bit each: beside thin bodies not all do that are near it.

use super::sift::NearTest;
use super::table::Rows;
use crate::formulations::fluid::lists::sides::Sides;
use crate::neighbors::NeighborList;
use crate::parallel::{BlockLoop, EIGHT, EightLanes, Lanes8, Split, for_each_block, run_blocks_on};

/// One in the lanes whose bits are set, zero in the others.
pub static SEEN: [Lanes8; 256] = masks();

const fn masks() -> [Lanes8; 256] {
    let mut masks = [Lanes8::ZERO; 256];
    let mut bits = 0;
    while bits < masks.len() {
        let mut lane = 0;
        while lane < EIGHT {
            if bits >> lane & 1 == 1 {
                masks[bits].0[lane] = 1.0;
            }
            lane += 1;
        }
        bits += 1;
    }
    masks
}

/// Writes for each pair of `list`, of blocks and fluid particles, the bits of the near particles that see the
/// neighbour past all boundary particles near them, `walls`.
pub fn see_fluid(
    seen: &mut Vec<u8>,
    near: NearTest<'_>,
    list: &NeighborList,
    sides: &Sides<'_>,
    walls: &NeighborList,
) {
    seen.resize(list.pairs(), 0);
    let rows = SeenRows { offsets: list.offsets(), bits: seen };
    for_each_block(rows, &mut Vec::new(), &|first, rows: SeenRows<'_>| {
        run_blocks_on(near.plane, SeenLoop { near, list, sides, walls, first, rows });
    });
}

/// The bits of the pairs of some rows of a list.
struct SeenRows<'a> {
    /// Starts of the rows in the list, and the end of the last.
    offsets: &'a [usize],
    bits: &'a mut [u8],
}

impl Split for SeenRows<'_> {
    fn rows(&self) -> usize {
        self.offsets.len() - 1
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (bits, rest) = self.bits.split_at_mut(self.offsets[at] - self.offsets[0]);
        (Self { offsets: &self.offsets[..=at], bits }, Self { offsets: &self.offsets[at..], bits: rest })
    }
}

struct SeenLoop<'a> {
    near: NearTest<'a>,
    list: &'a NeighborList,
    sides: &'a Sides<'a>,
    walls: &'a NeighborList,
    first: usize,
    rows: SeenRows<'a>,
}

impl BlockLoop for SeenLoop<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        let Self { near, list, sides, walls, first, rows } = self;
        let count = rows.rows();
        let mut rest = rows.bits;
        for block in first..first + count {
            let row = list.row(block);
            let (bits, behind) = rest.split_at_mut(row.len());
            rest = behind;
            let (of_block, particles) = (near.of_block(a, block), &near.table.rows[block]);
            for (bits, &j) in bits.iter_mut().zip(row) {
                let near = of_block.bits(a, j);
                let sees = |lane: &usize| {
                    near >> lane & 1 == 1 && sides.sees(particles[*lane] as usize, j as usize, walls)
                };
                *bits = (0..EIGHT).filter(sees).fold(0, |bits, lane| bits | 1 << lane);
            }
        }
    }
}

/// Writes for each pair of `joined`, whose rows are those of blocks, the bits of the particles that have it
/// in `list`.
pub fn see_walls(seen: &mut Vec<u8>, blocks: &[Rows], joined: &NeighborList, list: &NeighborList) {
    seen.clear();
    seen.resize(joined.pairs(), 0);
    for (block, rows) in blocks.iter().enumerate() {
        let seen = &mut seen[joined.range(block)];
        let joined = joined.row(block);
        for (lane, &row) in rows.iter().enumerate() {
            for j in list.row(row as usize) {
                if let Ok(at) = joined.binary_search(j) {
                    seen[at] |= 1 << lane;
                }
            }
        }
    }
}
