//! Which particles of a block see a neighbour, a bit each: beside thin bodies not all do that are near it.

use super::table::Rows;
use crate::neighbors::NeighborList;
use crate::parallel::{EIGHT, Lanes8};

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

/// Writes for each pair of `joined`, whose rows are those of blocks, the bits of the particles that have it
/// in `list`.
pub fn write_seen(seen: &mut Vec<u8>, blocks: &[Rows], joined: &NeighborList, list: &NeighborList) {
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
