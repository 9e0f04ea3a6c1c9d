//! The places that become the reference: those of the particles without what no gradient sees.
//!
//! If the places themselves were the reference, zero-energy motions would get into its pair vectors, and the next increments of the deformation gradient
//! would see a part of them: their product F drifts away from the map that the material has really gone through, the more the more often the reference is updated.
//! What a neighbourhood has moved beyond the mean of the gradients at both ends of its bonds,
//!
//! `s_i = sum_j V_j w_ij [u_ij - (H_i + H_j) r_ij / 2] / sum_j V_j w_ij ,   H = f - I`,
//!
//! vanishes for affine motions, is of third order for smooth ones, and is -1.2 to -1.4 times the amplitude for a saw-tooth. The reference is x + theta s. As the
//! particles are not at its places, f is not I there; F_r = f^-1 F, so that an update does not change F.

use glam::{DMat3, DVec3};

use super::columns::UpdatedReference;
use super::phase::UpdatedRows;
use crate::formulations::total_lagrangian::fit_gradients;
use crate::parallel::for_each_block;
use crate::world::Damage;

/// theta: it takes nine tenths of a saw-tooth along one axis of a square lattice, and all of a checkerboard.
const SHARE: f64 = 0.75;
/// Largest distance of a reference place from its particle, over the smoothing length.
const FARTHEST: f64 = 0.25;

/// f - I of all rows of the phase, ghosts too, at the places that the sites hold.
pub(super) fn increments(packed: &UpdatedRows, plane: bool) -> Vec<DMat3> {
    let UpdatedRows { bonds, ghosts, sites, volume, .. } = packed;
    let mut gradient = vec![DMat3::ZERO; sites.len()];
    fit_gradients((bonds, sites), plane, 0, &mut gradient[..volume.len()]);
    ghosts.fill(&mut gradient, |ghost, h| ghost.map.tensor(*h));
    gradient
}

/// Moves the places of the rows from `first` on, which are those of particles, off to where the reference is to be; `h` is the smoothing length, m. What has
/// failed stays.
pub(super) fn smooth(
    packed: &UpdatedRows,
    increments: &[DMat3],
    damage: Option<&[Damage]>,
    (first, h): (usize, f64),
    places: &mut [UpdatedReference],
) {
    let UpdatedRows { bonds, sites, .. } = packed;
    for_each_block(places, &mut Vec::new(), &|start, places: &mut [UpdatedReference]| {
        for (k, place) in places.iter_mut().enumerate() {
            let i = first + start + k;
            let own = &sites[i];
            if !own.is_present() || damage.is_some_and(|damage| damage[i].0 >= 1.0) {
                continue;
            }
            let (mut sum, mut total) = (DVec3::ZERO, 0.0);
            for (j, weight) in bonds.row(i) {
                let other = &sites[j];
                let weight = f64::from(weight) * other.reference.0[3];
                let arm = other.reference.xyz() - own.reference.xyz();
                let change = other.displacement.xyz() - own.displacement.xyz();
                sum += (change - (increments[i] + increments[j]) * (0.5 * arm)) * weight;
                total += weight;
            }
            if total > 0.0 {
                place.0 += (sum * (SHARE / total)).clamp_length_max(FARTHEST * h);
            }
        }
    });
}
