//! The neighbours of every fluid particle, selected from those of its block: for passes over single particles
//! where thin bodies hide neighbours.

use crate::formulations::fluid::cloud::FlowCloud;
use crate::formulations::fluid::lists::NearWriter;
use crate::formulations::fluid::lists::blocks::Blocks;
use crate::parallel::{FourLanes, HotLoop, for_each_block, run_hot};

impl FlowCloud {
    /// Writes down the neighbours of every particle.
    pub(in crate::formulations::fluid) fn pack_rows(&mut self, blocks: &Blocks) {
        let mut near = std::mem::take(&mut self.near);
        for_each_block(near.writer(), &mut Vec::new(), &|first, near: NearWriter<'_>| {
            run_hot(NearRowsOfBlocks { blocks, first, near });
        });
        self.near = near;
    }
}

struct NearRowsOfBlocks<'a> {
    blocks: &'a Blocks,
    first: usize,
    near: NearWriter<'a>,
}

impl HotLoop for NearRowsOfBlocks<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(mut self, a: A) {
        let Blocks { lists, near: of_blocks, .. } = self.blocks;
        for k in 0..self.near.len() {
            let i = self.first + k;
            let (block, lane) = lists.table.place(i);
            let mut row = self.near.row(k);
            let (rows, bits) = (of_blocks.row(block), of_blocks.lanes(block));
            let ((fours, rest), (fours_of_bits, rest_of_bits)) = (rows.as_chunks(), bits.as_chunks());
            for n in 0..fours.len() {
                row.push(a, fours[n], others(fours[n], fours_of_bits[n], lane, i as u32));
            }
            for n in 0..rest.len() {
                let is_near = others([rest[n], 0, 0, 0], [rest_of_bits[n], 0, 0, 0], lane, i as u32);
                row.push(a, [rest[n]; 4], is_near);
            }
            row.close();
        }
    }
}

/// A bit for each of four neighbours that are near the particle in that lane, which is in row `i`, and not
/// the particle itself.
#[inline(always)]
fn others(rows: [u32; 4], bits: [u8; 4], lane: usize, i: u32) -> usize {
    let mut near = 0;
    for n in 0..4 {
        near |= (usize::from(bits[n]) >> lane & usize::from(rows[n] != i)) << n;
    }
    near
}
