//! From the sums of the blocks to the rows of the particles, in double precision.

use glam::DVec3;

use super::super::pair_force::ForceRows;
use crate::formulations::fluid::cloud::PARTS;
use crate::formulations::fluid::lists::blocks::Table;
use crate::pair::TermRows;
use crate::parallel::{Lanes8, Split, for_each_block};
use crate::world::Force;

/// Sums of the flow itself: of the pressures of fluids, of friction, of the pressures of boundaries.
pub const FIXED: usize = 9;

/// Vectors of a block with that many terms: those of the flow, three for the force of each term, and one for the density rates.
pub fn stride(terms: usize) -> usize {
    FIXED + 3 * terms + usize::from(terms > 0)
}

/// The way back.
pub struct Landing<'a> {
    pub table: &'a Table,
    /// First block of the fluid, and its first row in the cloud.
    pub first_block: usize,
    pub first_row: usize,
    pub forces: &'a [Lanes8],
}

impl Landing<'_> {
    /// Writes the forces, [`PARTS`] parts of each, and what the terms make.
    pub fn run(&self, written: TermRows<'_>, parts: &mut [DVec3]) {
        let terms = written.terms();
        let stride = stride(terms);
        for_each_block(ForceRows { written, parts }, &mut Vec::new(), &|first, rows: ForceRows<'_>| {
            let ForceRows { mut written, parts } = rows;
            for k in 0..written.rows() {
                let (block, lane) = self.table.place(self.first_row + first + k);
                let sums = &self.forces[(block - self.first_block) * stride..][..stride];
                let (viscous, wall) = (vector(sums, 3, lane), vector(sums, 6, lane));
                written.total[k] = Force(viscous - vector(sums, 0, lane) - wall);
                parts[PARTS * k] = viscous;
                parts[PARTS * k + 1] = -wall;
                for term in 0..terms {
                    written.put_force(k, term, vector(sums, FIXED + 3 * term, lane));
                }
                if terms > 0 {
                    written.put_density(k, f64::from(sums[stride - 1].0[lane]));
                }
            }
        });
    }
}

#[inline(always)]
fn vector(sums: &[Lanes8], at: usize, lane: usize) -> DVec3 {
    let of = |axis: usize| f64::from(sums[at + axis].0[lane]);
    DVec3::new(of(0), of(1), of(2))
}
