//! Particles that lose their neighbours see farther, or carry no stress.
//!
//! The support radius stays what it is while a body flows: it is the neighbours that change. Where the material is drawn out, the next particle along that direction may be farther away
//! than the support radius. The fit of the deformation gradient is then singular, or so nearly that its derivative, and with it the frequency of the particle, is without bound. Such a particle gets a larger
//! support radius, once and for all; where that does not help it carries no stress.

use super::phase::UpdatedRows;
use crate::linalg::{Eigen, Sym3};
use crate::world::{Damage, SupportRadius, World};

/// Smallest eigenvalue of a moment matrix, which is 1 inside of a body, 1/2 at a face and 1/8 in a corner, below which the support grows.
const FEW: f64 = 0.05;
/// Smallest eigenvalue below which a particle carries no stress.
const LOST: f64 = 0.02;
/// Factor by which a support radius grows at a time.
const GROWTH: f64 = 1.2;
/// Largest support radius over the first one.
const LARGEST: f64 = 2.0;

/// Widens the support of particles that have lost neighbours; returns whether there are any, so that the lists have to be made again. What can fail may tear.
pub(super) fn widen(
    packed: &UpdatedRows,
    world: &World,
    damage: Option<&[Damage]>,
    support: &mut [SupportRadius],
) -> bool {
    let mut has_grown = false;
    if damage.is_some() {
        return has_grown;
    }
    for kernel in &packed.kernels {
        let Some(first) = kernel.support else { continue };
        for row in world.body(kernel.body).rows.clone().filter(|&row| packed.volume[row] > 0.0) {
            let inverse = &packed.bonds.inverse_moment[row];
            let grown = GROWTH * support[row].0;
            if grown <= LARGEST * first && (*inverse == Sym3::ZERO || is_below(FEW, inverse)) {
                support[row].0 = grown;
                has_grown = true;
            }
        }
    }
    has_grown
}

impl UpdatedRows {
    /// Lets go of particles whose fit is nearly singular.
    pub fn release_lost(&mut self) {
        for row in 0..self.bonds.inverse_moment.len() {
            if is_below(LOST, &self.bonds.inverse_moment[row]) {
                self.bonds.release(row);
            }
        }
    }
}

/// Whether the matrix that has this inverse has an eigenvalue below a limit.
fn is_below(limit: f64, inverse: &Sym3) -> bool {
    // The largest eigenvalue of a positive matrix is at most its trace.
    let most = 1.0 / limit;
    inverse.trace() > most && Eigen::new(inverse).values.max_element() > most
}
