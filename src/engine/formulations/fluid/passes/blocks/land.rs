//! From the sums of a block to the rows of its particles, in double precision.

use glam::DVec3;

use super::super::pair_force::ForceRows;
use super::pairs::BlockForces;
use crate::formulations::fluid::cloud::PARTS;
use crate::formulations::fluid::lists::blocks::Rows;
use crate::pair::TermSums;
use crate::parallel::{EIGHT, Lanes8};
use crate::world::Force;

/// Where the sums of a block go.
pub struct BlockOutput<'a> {
    pub particles: &'a Rows,
    /// The first of the rows.
    pub first: usize,
    /// Whether vectors have no z.
    pub plane: bool,
    /// Whether forces are added to the present values.
    pub adds: bool,
}

/// Writes the forces on the particles of a block, [`PARTS`] parts of each, and the results of the terms.
pub fn land(sums: &BlockForces, of_terms: &[TermSums], landing: BlockOutput<'_>, rows: &mut ForceRows<'_>) {
    let BlockOutput { particles, first, plane, adds } = landing;
    let ForceRows { written, parts } = rows;
    for lane in 0..EIGHT {
        // Lanes without a particle repeat the last one.
        if adds && lane > 0 && particles[lane] == particles[lane - 1] {
            break;
        }
        let vector = |[x, y, z]: &[Lanes8; 3]| {
            let z = if plane { 0.0 } else { f64::from(z.0[lane]) };
            DVec3::new(f64::from(x.0[lane]), f64::from(y.0[lane]), z)
        };
        let k = particles[lane] as usize - first;
        let (viscous, wall) = (vector(&sums.viscous), vector(&sums.wall));
        let before = if adds { written.total[k].0 } else { DVec3::ZERO };
        written.total[k] = Force(before + viscous - vector(&sums.pressure) - wall);
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
