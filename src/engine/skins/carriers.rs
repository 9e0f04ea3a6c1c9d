//! The particles that carry the vertices of a skin.
//!
//! Near symmetry planes mirror images of particles are carriers as well: an image stands for the particle
//! that carries the image of the vertex. A skin that ends at a plane is then half of the skin of the whole
//! body. At the ends of a period images a period away are carriers.
//!
//! Particles that have been moved onto a held side represent the cells that they had in their lattice: shares
//! follow from their lattice positions. With their present positions, the first layer beside the side would
//! carry three quarters of a load that acts on its cell, and the next one five quarters.

use glam::DVec3;

use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::shapes::Aabb;
use crate::symmetry::Map;

/// Reach of a vertex over the spacing: of 1.6, 2, 2.1 and 2.41, at the usual support, the one with the
/// minimum error of the traction.
pub(super) const REACH: f64 = 2.1;
/// By how much the reach grows for vertices with fewer than [`FEWEST`] particles.
const WIDER: f64 = 1.25;
const FEWEST: usize = 3;
/// Searches after which a vertex has no particles near it.
const SEARCHES: usize = 6;

/// The particles of a body as carriers.
pub(super) struct CarrierCells<'a> {
    /// Where they are, m.
    pub places: &'a [DVec3],
    /// Where the middles of their cells are, m.
    pub middles: &'a [DVec3],
}

/// A particle that carries a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carrier {
    /// From the particle to the vertex, or to its image, in the reference configuration, m.
    pub arm: DVec3,
    /// Share in the vertex.
    pub weight: f64,
    /// Number of the particle in its body.
    pub particle: u32,
    /// Number of the map from the particle to what carries the vertex; 0 is the particle itself.
    pub map: u32,
}

/// The carriers of all vertices, with where those of each begin. None if a vertex is far from all particles.
/// The first of the maps changes nothing. Particles up to `farther` times the reach become carriers too,
/// without a share at the start.
pub(super) fn carriers(
    vertices: &[DVec3],
    cells: &CarrierCells<'_>,
    maps: &[Map],
    spacing: f64,
    farther: f64,
) -> Result<Option<(Vec<u32>, Vec<Carrier>)>, NeighborError> {
    let farthest = farther * REACH * WIDER.powi(SEARCHES as i32) * spacing;
    let around = Aabb::around(vertices.iter().copied());
    let images = images(cells.middles, maps, Aabb { min: around.min - farthest, max: around.max + farthest });
    let places: Vec<DVec3> = images.iter().map(|image| image.0).collect();
    let mut all: Vec<Vec<Carrier>> = vec![Vec::new(); vertices.len()];
    let mut pending: Vec<usize> = (0..vertices.len()).collect();
    let (mut search, mut list) = (NeighborSearch::default(), NeighborList::default());
    let fewest = FEWEST.min(cells.places.len());
    let mut reach = REACH * spacing;
    for _ in 0..SEARCHES {
        let targets: Vec<DVec3> = pending.iter().map(|&k| vertices[k]).collect();
        let cloud = |positions| Cloud::uniform(positions, farther * reach);
        search.between(cloud(&targets), cloud(&places), 0.0, &Periodic::NONE, &mut list)?;
        let mut few = Vec::new();
        for (row, &k) in pending.iter().enumerate() {
            let near = list.row(row);
            if near.len() < fewest {
                few.push(k);
            } else {
                let found = near.iter().map(|&number| images[number as usize]);
                all[k] = shares(vertices[k], cells, maps, found, reach);
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

/// A particle or an image of it: where it is, m, its number, and the number of its map.
type Image = (DVec3, u32, u32);

/// All particles, and their images in a box.
fn images(particles: &[DVec3], maps: &[Map], within: Aabb) -> Vec<Image> {
    let mut images = Vec::new();
    for (number, map) in (0..).zip(maps) {
        let all = (0..).zip(particles).map(|(particle, x)| (map.place(*x), particle, number));
        images.extend(all.filter(|(place, _, map)| {
            *map == 0 || (place.cmpge(within.min) & place.cmple(within.max)).all()
        }));
    }
    images
}

fn shares(
    vertex: DVec3,
    cells: &CarrierCells<'_>,
    maps: &[Map],
    near: impl Iterator<Item = Image>,
    reach: f64,
) -> Vec<Carrier> {
    let of = |(middle, particle, map): Image| {
        // For vectors a map is its own inverse.
        let way = vertex - middle;
        let weight = (1.0 - way.length() / reach).max(0.0).powi(3);
        let moved = cells.places[particle as usize] - cells.middles[particle as usize];
        Carrier { arm: maps[map as usize].vector(way) - moved, weight, particle, map }
    };
    let mut carriers: Vec<Carrier> = near.map(of).collect();
    let sum: f64 = carriers.iter().map(|carrier| carrier.weight).sum();
    carriers.iter_mut().for_each(|carrier| carrier.weight /= sum);
    carriers
}
