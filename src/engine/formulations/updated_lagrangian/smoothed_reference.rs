//! The positions that become the reference: close to the particles, but free of zero-energy motions.
//!
//! If the particle positions themselves were the reference, zero-energy motions would enter its pair vectors, and the next increments of the deformation gradient
//! would contain part of them. The operator changes with every update: what enters F as such a motion grows does not leave F as it decays. F would
//! drift away from the deformation of the material, faster with more frequent updates, and a vibrating body would permanently keep a part of its
//! energy as strain that no motion releases.
//!
//! The reference is therefore relaxed from the positions towards pair vectors that follow from F and the original ones alone,
//!
//! `x_r,i <- x_r,i + theta sum_j V_j w_ij [r_ij - (F_i + F_j) X_ij / 2] / sum_j V_j w_ij`,
//!
//! a few times. The bracket vanishes for affine motions and is of third order for smooth ones; for zero-energy motions it is the part that the gradient does not see. It is measured from
//! the original configuration and not from the last update, so that the remainder of one update is removed by the next. The particles are not at the relaxed positions and f is not I there; F_r = f^-1 F, so that an
//! update does not change F.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::columns::UpdatedReference;
use super::phase::UpdatedRows;
use crate::formulations::total_lagrangian::fit_gradients;
use crate::parallel::for_each_block;
use crate::world::{Damage, DeformationGradient};

/// theta: it takes nine tenths of a saw-tooth along one axis of a square lattice at once, and all of a checkerboard.
const SHARE: f64 = 0.75;
/// How many times: two rubber rings that collide with updates every three steps rebound 1.5 % too slowly after one time, as without updates after three.
const TIMES: usize = 3;
/// Largest distance of a reference place from its particle, over the smoothing length.
const FARTHEST: f64 = 0.25;

/// f - I of all rows of the phase, ghosts too, at the places that the sites hold.
pub(super) fn increments(packed: &UpdatedRows, plane: bool) -> Vec<DMat3> {
    let UpdatedRows { bonds, ghosts, sites, volume, .. } = packed;
    let mut gradient = vec![DMat3::ZERO; sites.len()];
    fit_gradients(bonds, sites, plane, 0, &mut gradient[..volume.len()]);
    ghosts.fill(&mut gradient, |ghost, h| ghost.map.tensor(*h));
    gradient
}

/// What the reference places of a body are smoothed by.
pub(super) struct Smoothing<'a> {
    pub packed: &'a UpdatedRows,
    /// Original positions, m.
    pub original: &'a [DVec3],
    pub deformation: &'a [DeformationGradient],
    pub damage: Option<&'a [Damage]>,
    /// Smoothing length, m.
    pub h: f64,
}

/// Moves the reference places of the rows of a body, which are those of its particles, to where the reference is to be. What has failed stays, and moves nothing.
pub(super) fn smooth(by: &Smoothing<'_>, rows: Range<usize>, places: &mut [UpdatedReference]) {
    let Smoothing { packed, original, deformation, damage, h } = *by;
    let UpdatedRows { bonds, ghosts, volume, .. } = packed;
    let holds = |row: usize| damage.is_none_or(|damage| damage[row].0 < 1.0);
    let held: Vec<f64> =
        volume.iter().enumerate().map(|(row, v)| if holds(row) { *v } else { 0.0 }).collect();
    let start: Vec<DVec3> = places.iter().map(|place| place.0).collect();
    let mut now = start.clone();
    for _ in 0..TIMES {
        let own = &mut places[rows.clone()];
        for_each_block(own, &mut Vec::new(), &|first, own: &mut [UpdatedReference]| {
            for (k, place) in own.iter_mut().enumerate() {
                let i = rows.start + first + k;
                if held[i] == 0.0 {
                    continue;
                }
                let (mut sum, mut total) = (DVec3::ZERO, 0.0);
                for (j, weight) in bonds.row(i) {
                    let (source, x_ij) = (ghosts.source(j), ghosts.pair(original, i, j));
                    let theirs = match ghosts.mirror(j) {
                        Some(signs) => signs * (deformation[source].0 * (signs * x_ij)),
                        None => deformation[source].0 * x_ij,
                    };
                    let expected = deformation[i].0 * x_ij + theirs;
                    let weight = f64::from(weight) * held[source];
                    sum += (ghosts.pair(&now, i, j) - 0.5 * expected) * weight;
                    total += weight;
                }
                if total > 0.0 {
                    let moved = now[i] + sum * (SHARE / total) - start[i];
                    place.0 = start[i] + moved.clamp_length_max(FARTHEST * h);
                }
            }
        });
        for row in rows.clone() {
            now[row] = places[row].0;
        }
    }
}
