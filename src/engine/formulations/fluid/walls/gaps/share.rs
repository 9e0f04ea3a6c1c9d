//! The opposite of the force on a particle beside a gap, on the particles of the other bodies around it.
//!
//! They take shares by their weights, changed linearly in space so that their centre is on the line along
//! which the force acts: momentum and angular momentum are conserved. Where that would need large shares of
//! opposite signs, only the part of the force along the line to their centre remains.

use glam::{DMat3, DVec3};

use super::moments::GapPair;
use crate::formulations::fluid::cloud::FlowCloud;
use crate::linalg::dyad;

/// Square of the distance of the line from the centre of the particles, in their standard deviations, up to
/// which the shares are changed.
const OUTSIDE: f64 = 16.0;
/// Minimum determinant of the moments of the particles that fixes a change, over that of a full support.
const FLAT: f64 = 1e-9;

/// Gives a force on a particle, N, to itself and its opposite to those across the gap, as far as the gap is
/// looked at from this side.
pub fn give(cloud: &FlowCloud, row: usize, force: DVec3, across: &[GapPair], out: &mut [DVec3]) {
    let weight = |pair: &GapPair| cloud.pairs.gaps.share_of(row, pair.row) * pair.value;
    let total: f64 = across.iter().map(weight).sum();
    let whole: f64 = across.iter().map(|pair| pair.value).sum();
    let Some(direction) = force.try_normalize().filter(|_| total > 0.0) else { return };
    let force = total / whole * force;
    let mean = across.iter().map(|pair| weight(pair) * pair.x).sum::<DVec3>() / total;
    let apart = mean.dot(direction) * direction - mean;
    let mut moment = DMat3::ZERO;
    for pair in across {
        moment += weight(pair) / total * dyad(pair.x - mean, pair.x - mean);
    }
    if cloud.plane {
        moment.z_axis.z = 1.0;
    }
    let full = cloud.kernel.support.powi(if cloud.plane { 4 } else { 6 });
    let is_wide = moment.determinant() > FLAT * full;
    let slope = is_wide.then(|| moment.inverse() * apart).filter(|slope| slope.dot(apart) < OUTSIDE);
    // Of few particles, only what is along the line to their centre.
    let centre = mean.normalize_or_zero();
    let force = if slope.is_some() { force } else { force.dot(centre) * centre };
    let slope = slope.unwrap_or_default();
    out[row - cloud.fluid] += force;
    for pair in across {
        let share = weight(pair) / total * (1.0 + (pair.x - mean).dot(slope));
        out[pair.row - cloud.fluid] -= share * force;
    }
}
