//! From the sums of the blocks to the rows of the particles, in double precision.

use glam::DVec3;

use super::super::pair_force::ForceRows;
use crate::formulations::fluid::cloud::PARTS;
use crate::formulations::fluid::lists::blocks::BlockTable;
use crate::pair::TermRows;
use crate::parallel::{Lanes8, Split, for_each_own_block};
use crate::world::Force;

/// Sums of the flow itself: of the pressures of fluids, of friction, of the pressures of boundaries.
pub const FIXED: usize = 9;

/// Vectors of a block with that many terms: those of the flow, three for the force of each term, and one for the density rates.
pub fn stride(terms: usize) -> usize {
    FIXED + 3 * terms + usize::from(terms > 0)
}

/// The way back.
pub struct Landing<'a> {
    pub table: &'a BlockTable,
    /// First block of the fluid, and its first row in the cloud.
    pub first_block: usize,
    pub first_row: usize,
    pub forces: &'a [Lanes8],
    pub plane: bool,
}

impl Landing<'_> {
    /// The vector of a lane; in the plane it has no z.
    #[inline(always)]
    fn vector(&self, x: &Lanes8, y: &Lanes8, z: &Lanes8, lane: usize) -> DVec3 {
        let z = if self.plane { 0.0 } else { f64::from(z.0[lane]) };
        DVec3::new(f64::from(x.0[lane]), f64::from(y.0[lane]), z)
    }

    /// Writes the forces on the particles that this rank computes, [`PARTS`] parts of each, and what the terms make.
    pub fn run(&self, written: TermRows<'_>, parts: &mut [DVec3]) {
        let terms = written.terms();
        let stride = stride(terms);
        for_each_own_block(ForceRows { written, parts }, &mut Vec::new(), &|first, rows: ForceRows<'_>| {
            let ForceRows { mut written, parts } = rows;
            for k in 0..written.rows() {
                let (block, lane) = self.table.place(self.first_row + first + k);
                let sums = &self.forces[(block - self.first_block) * stride..][..stride];
                let Some((fixed, of_terms)) = sums.split_first_chunk::<FIXED>() else {
                    unreachable!("stride")
                };
                let vector = |at: usize| self.vector(&fixed[at], &fixed[at + 1], &fixed[at + 2], lane);
                let (viscous, wall) = (vector(3), vector(6));
                written.total[k] = Force(viscous - vector(0) - wall);
                parts[PARTS * k] = viscous;
                parts[PARTS * k + 1] = -wall;
                let (forces, density) = of_terms.as_chunks::<3>();
                for (term, [x, y, z]) in forces.iter().enumerate() {
                    written.put_force(k, term, self.vector(x, y, z, lane));
                }
                if let [density] = density {
                    written.put_density(k, f64::from(density.0[lane]));
                }
            }
        });
    }
}
