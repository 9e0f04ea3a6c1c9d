//! Pairs of a body that touches itself: kernel neighbours, or two surfaces in contact.
//!
//! The deformation of a particle implies the original distance of a pair that is now `x_ij` apart: `|F^-1
//! x_ij|`. Where the real original distance was much larger, no deformation has brought the two particles
//! together: two surfaces of the body meet. Within the support, a pair is either in the kernel sums or in
//! contact.

use glam::{DMat3, DVec3};

use super::lists::EulerianLists;
use crate::world::DeformationGradient;

/// A pair is in contact if its original distance exceeds this many supports and this many times the distance
/// that the deformation implies. Slip along a shear band one particle wide counts as deformation until then.
const ELSEWHERE: f64 = 2.5;

impl EulerianLists {
    /// Leaves pairs in contact out of the rows of bodies that touch themselves. The result depends on the
    /// current state alone, not on the age of the lists.
    pub fn leave_out_elsewhere(
        &mut self,
        position: &[DVec3],
        reference: &[DVec3],
        deformation: &[DeformationGradient],
    ) {
        let Self { bodies, ghosts, pairs, uncut, .. } = self;
        if bodies.iter().all(|body| !body.touches_itself) {
            return;
        }
        pairs.clear();
        for body in bodies {
            let near = ELSEWHERE * body.support;
            for i in body.rows.clone() {
                pairs.push_row(uncut.row(i).iter().copied().filter(|&j| {
                    let j = j as usize;
                    if !body.touches_itself {
                        return true;
                    }
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
        }
    }
}
