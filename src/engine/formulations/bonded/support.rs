//! A support radius for every particle of an irregular body.
//!
//! `H_i` is half-way between the distances of the n-th and of the next neighbour, and a pair interacts within
//! the mean of its two radii (Ganzenmueller 2015, section 4.1, whose clouds of particles have 12 neighbours
//! each).

use glam::DVec3;
use rayon::prelude::*;

use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};

/// Factor by which the search widens for particles that have not yet found their neighbours.
const WIDER: f64 = 1.5;

/// Chooses the support radius of every particle, m, from the distances of its nearest neighbours; `first` is
/// the radius of the first search, m. There must be at least `neighbors + 2` particles.
pub(in crate::formulations) fn choose_support(
    position: &[DVec3],
    first: f64,
    neighbors: usize,
    support: &mut [f64],
) -> Result<(), NeighborError> {
    let mut search = NeighborSearch::default();
    let mut list = NeighborList::default();
    let mut pending: Vec<usize> = (0..position.len()).collect();
    let mut radius = first;
    while !pending.is_empty() {
        let targets: Vec<DVec3> = pending.iter().map(|&i| position[i]).collect();
        let cloud = |positions| Cloud::uniform(positions, radius);
        search.between(cloud(&targets), cloud(position), 0.0, &Periodic::NONE, &mut list)?;
        let found: Vec<Option<f64>> = (0..pending.len())
            .into_par_iter()
            .map(|k| {
                let distance = |&j: &u32| (position[j as usize] - targets[k]).length();
                let mut distances: Vec<f64> = list.row(k).iter().map(distance).collect();
                distances.sort_unstable_by(f64::total_cmp);
                // The first is the particle itself.
                Some(0.5 * (distances.get(neighbors)? + distances.get(neighbors + 1)?))
            })
            .collect();
        let mut late = Vec::new();
        for (&i, radius) in pending.iter().zip(found) {
            match radius {
                Some(radius) => support[i] = radius,
                None => late.push(i),
            }
        }
        pending = late;
        radius *= WIDER;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_particle_sees_as_many_neighbours_as_asked_for() {
        let noise = |k: usize, c: f64| ((k as f64 * 12.9898 + c) * 43.5453).sin().abs();
        let cloud: Vec<DVec3> = (0..300).map(|k| DVec3::new(noise(k, 0.1), noise(k, 7.3), 0.0)).collect();
        let mut support = vec![0.0; cloud.len()];
        choose_support(&cloud, 0.01, 12, &mut support).expect("supports");
        for (i, radius) in support.iter().enumerate() {
            let mut all: Vec<f64> = cloud.iter().map(|x| (*x - cloud[i]).length()).collect();
            all.sort_by(f64::total_cmp);
            assert_eq!(*radius, 0.5 * (all[12] + all[13]), "particle {i}");
        }
    }
}
