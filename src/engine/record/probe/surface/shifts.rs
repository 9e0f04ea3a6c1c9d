//! How far from a particle, into the body, its deformation gradient is that of the body.

use glam::{DMat3, DVec3};

use crate::correction::MomentMatrix;
use crate::kernels::Kernel;
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::plugin::BodyPlan;
use crate::symmetry::Map;

/// The shifts of these particles, m, with the kernel and the support radius, m, of the body, which continues
/// in these maps.
pub(super) fn shifts(
    particles: &[u32],
    body: &BodyPlan,
    kernel: &Kernel,
    support: f64,
    maps: &[Map],
) -> Result<Vec<DVec3>, NeighborError> {
    let is_seen = |k: &usize| body.hidden.binary_search(&(*k as u32)).is_err();
    let seen: Vec<usize> = (0..body.sites.len()).filter(is_seen).collect();
    let images = |map: &Map| {
        seen.iter().map(|&k| (map.place(body.sites[k].position), body.sites[k].volume)).collect::<Vec<_>>()
    };
    let near: Vec<(DVec3, f64)> = maps.iter().flat_map(images).collect();
    let places: Vec<DVec3> = near.iter().map(|(place, _)| *place).collect();
    let targets: Vec<DVec3> = particles.iter().map(|&k| body.sites[k as usize].position).collect();
    let mut list = NeighborList::default();
    let cloud = |positions| Cloud::uniform(positions, support);
    NeighborSearch::default().between(cloud(&targets), cloud(&places), 0.0, &Periodic::NONE, &mut list)?;
    let h = kernel.smoothing_length(support);
    let of = |(row, place): (usize, &DVec3)| {
        let arm = |&other: &u32| {
            let (other, volume) = near[other as usize];
            let arm = other - place;
            let distance = arm.length();
            (distance > 0.0).then(|| (volume * kernel.pair_weight(distance, h), arm))
        };
        shift(&list.row(row).iter().filter_map(arm).collect::<Vec<_>>(), kernel.dimension())
    };
    Ok(targets.iter().enumerate().map(of).collect())
}

/// The shift of a particle with these neighbours: their `V_j w_ij`, 1/m2, and `X_ij`, m.
pub(super) fn shift(near: &[(f64, DVec3)], axes: usize) -> DVec3 {
    let inward = near.iter().map(|(weight, arm)| *weight * *arm).sum::<DVec3>().normalize_or_zero();
    let mut moment = MomentMatrix::new(axes);
    near.iter().for_each(|(weight, arm)| moment.add(*weight, *arm));
    let Some(inverse) = moment.inverse() else { return DVec3::ZERO };
    let third = near.iter().fold(DMat3::ZERO, |sum, (weight, arm)| {
        let along = *arm * (weight * arm.dot(inward));
        sum + DMat3::from_cols(along * arm.x, along * arm.y, along * arm.z)
    });
    let slopes = third * inverse.to_matrix();
    let trace = slopes.x_axis.x + slopes.y_axis.y + slopes.z_axis.z;
    inward * ((trace - inward.dot(slopes * inward)) / (axes as f64 - 1.0))
}
