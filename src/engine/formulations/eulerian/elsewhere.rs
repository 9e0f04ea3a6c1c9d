//! Particles from elsewhere in a body that touches itself: they are in contact, not in the sums over the kernel.
//!
//! The deformation of a particle says how far apart two particles were that are now `x_ij` apart: `|F^-1 x_ij|`. Where they were much further apart at the start, no
//! deformation has brought them together: two sides of the body meet. A pair is in the sums or in contact, never in both and, within the support, never in neither.

use glam::{DMat3, DVec3};

use super::lists::Lists;
use crate::world::DeformationGradient;

/// Two particles come from elsewhere if they were further apart at the start than this times the distance that their deformation says, and the support.
/// Slip along a shear band of a particle's width passes for deformation until it has left the support twice behind.
const ELSEWHERE: f64 = 2.5;

impl Lists {
    /// Leaves particles from elsewhere out of the rows of bodies that touch themselves: a function of the present state alone, whenever the lists were built.
    pub fn leave_out_elsewhere(
        &mut self,
        (position, reference): (&[DVec3], &[DVec3]),
        deformation: &[DeformationGradient],
    ) {
        let Self { bodies, ghosts, offsets, neighbors, uncut, .. } = self;
        if bodies.iter().all(|body| !body.touches_itself) {
            return;
        }
        neighbors.clear();
        let (starts, all) = (&uncut.0, &uncut.1);
        for body in bodies {
            let near = ELSEWHERE * body.support;
            for i in body.rows.clone() {
                offsets[i] = neighbors.len();
                let row = &all[starts[i]..starts[i + 1]];
                if !body.touches_itself {
                    neighbors.extend_from_slice(row);
                    continue;
                }
                neighbors.extend(row.iter().copied().filter(|&j| {
                    let j = j as usize;
                    let before = ghosts.pair(reference, i, j).length_squared();
                    if before <= near * near {
                        return true;
                    }
                    let x_ij = ghosts.pair(position, i, j);
                    let signs = ghosts.mirror(j).unwrap_or(DVec3::ONE);
                    let said = |f: &DMat3, x: DVec3| (f.inverse() * x).length_squared();
                    let own = said(&deformation[i].0, x_ij);
                    let others = said(&deformation[ghosts.source(j)].0, x_ij * signs);
                    before <= ELSEWHERE * ELSEWHERE * own.max(others)
                }));
            }
            offsets[body.rows.end] = neighbors.len();
        }
    }
}
