//! The deformation gradient of bodies that start deformed: the fit of their positions to those of the
//! reference configuration.

use glam::{DMat3, DVec3};

use super::rows::EulerianRows;
use crate::correction::AffineFit;
use crate::world::DeformationGradient;

/// Fits F to the places of all particles; the lists are those of the reference configuration. Bodies that
/// start undeformed keep F = I, to the bit.
pub(super) fn fit_gradients(
    packed: &EulerianRows,
    reference: &[DVec3],
    position: &[DVec3],
    volume: &[f64],
    deformation: &mut [DeformationGradient],
) {
    let EulerianRows { lists, kernels, plane, .. } = packed;
    let ghosts = &lists.ghosts;
    for (body, of) in lists.bodies.iter().zip(kernels) {
        if body.rows.clone().all(|row| reference[row] == position[row]) {
            continue;
        }
        let h = of.kernel.smoothing_length(body.support);
        for i in body.rows.clone() {
            let mut fit = AffineFit::new(if *plane { 2 } else { 3 });
            for &j in lists.pairs.row(i) {
                let j = j as usize;
                let x_ij = ghosts.pair(reference, i, j);
                let weight = volume[ghosts.source(j)] * of.kernel.pair_weight(x_ij.length(), h);
                fit.add(weight, x_ij, ghosts.pair(position, i, j) - x_ij);
            }
            deformation[i].0 = DMat3::IDENTITY + fit.gradient().unwrap_or(DMat3::ZERO);
        }
    }
}
