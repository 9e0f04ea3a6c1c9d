//! Which particles carry the vertices of a skin.

use glam::DVec3;

use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};

/// Reach of a vertex over the spacing: of 1.6, 2, 2.1 and 2.41, at the usual support, the one with the least error of the traction.
const REACH: f64 = 2.1;
/// By how much the reach grows for vertices with fewer than [`FEWEST`] particles.
const WIDER: f64 = 1.25;
const FEWEST: usize = 3;
/// Searches after which a vertex has no particles near it.
const SEARCHES: usize = 6;

/// A particle that carries a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carrier {
    /// From the particle to the vertex in the reference configuration, m.
    pub arm: DVec3,
    /// Share in the vertex.
    pub weight: f64,
    /// Number of the particle in its body.
    pub particle: u32,
}

/// The carriers of all vertices, with where those of each begin. None if a vertex is far from all particles.
pub(super) fn carriers(
    vertices: &[DVec3],
    particles: &[DVec3],
    spacing: f64,
) -> Result<Option<(Vec<u32>, Vec<Carrier>)>, NeighborError> {
    let mut all: Vec<Vec<Carrier>> = vec![Vec::new(); vertices.len()];
    let mut pending: Vec<usize> = (0..vertices.len()).collect();
    let (mut search, mut list) = (NeighborSearch::default(), NeighborList::default());
    let fewest = FEWEST.min(particles.len());
    let mut reach = REACH * spacing;
    for _ in 0..SEARCHES {
        let targets: Vec<DVec3> = pending.iter().map(|&k| vertices[k]).collect();
        let cloud = |positions| Cloud::uniform(positions, reach);
        search.between(cloud(&targets), cloud(particles), 0.0, &Periodic::NONE, &mut list)?;
        let mut few = Vec::new();
        for (row, &k) in pending.iter().enumerate() {
            let near = list.row(row);
            if near.len() < fewest {
                few.push(k);
            } else {
                all[k] = shares(vertices[k], particles, near, reach);
            }
        }
        pending = few;
        if pending.is_empty() {
            break;
        }
        reach *= WIDER;
    }
    if !pending.is_empty() {
        return Ok(None);
    }
    let mut starts = vec![0];
    let mut carriers = Vec::new();
    for of_vertex in all {
        carriers.extend(of_vertex);
        starts.push(carriers.len() as u32);
    }
    Ok(Some((starts, carriers)))
}

fn shares(vertex: DVec3, particles: &[DVec3], near: &[u32], reach: f64) -> Vec<Carrier> {
    let weight = |arm: DVec3| (1.0 - arm.length() / reach).powi(3);
    let of = |&particle: &u32| {
        let arm = vertex - particles[particle as usize];
        Carrier { arm, weight: weight(arm), particle }
    };
    let mut carriers: Vec<Carrier> = near.iter().map(of).collect();
    let sum: f64 = carriers.iter().map(|carrier| carrier.weight).sum();
    carriers.iter_mut().for_each(|carrier| carrier.weight /= sum);
    carriers
}
