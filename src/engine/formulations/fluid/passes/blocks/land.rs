//! From the sums of a block to the rows of its particles, in double precision.

use glam::DVec3;

use super::super::pair_force::ForceRows;
use super::pairs::BlockForces;
use crate::formulations::fluid::cloud::PARTS;
use crate::formulations::fluid::lists::blocks::Rows;
use crate::pair::TermSums;
use crate::parallel::{EIGHT, Lanes8};
use crate::world::Force;

/// Writes the forces on the particles of a block, [`PARTS`](crate::formulations::fluid::cloud::PARTS) parts of each, and what the terms make; `first` is the first of the rows.
pub fn land(
    sums: &BlockForces,
    of_terms: &[TermSums],
    (particles, first): (&Rows, usize),
    plane: bool,
    rows: &mut ForceRows<'_>,
) {
    let ForceRows { written, parts } = rows;
    for lane in 0..EIGHT {
        // In the plane a vector has no z.
        let vector = |[x, y, z]: &[Lanes8; 3]| {
            let z = if plane { 0.0 } else { f64::from(z.0[lane]) };
            DVec3::new(f64::from(x.0[lane]), f64::from(y.0[lane]), z)
        };
        let k = particles[lane] as usize - first;
        let (viscous, wall) = (vector(&sums.viscous), vector(&sums.wall));
        written.total[k] = Force(viscous - vector(&sums.pressure) - wall);
        parts[PARTS * k] = viscous;
        parts[PARTS * k + 1] = -wall;
        let mut rate = 0.0;
        for (n, term) in of_terms.iter().enumerate() {
            written.put_force(k, n, vector(&term.force));
            rate += f64::from(term.density.0[lane]);
        }
        if !of_terms.is_empty() {
            written.put_density(k, rate);
        }
    }
}
