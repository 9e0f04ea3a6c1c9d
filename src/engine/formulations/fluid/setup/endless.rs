//! Periodic axes along which fluids are endless.
//!
//! A fluid that fills a period from one side to the other is beside its own image, and nothing carries its
//! weight along that axis: gravity drives it, as it does a film on a slope or the liquid in a tube. One that
//! a wall closes, or that ends at a surface, reaches its image nowhere.

use glam::DVec3;

use crate::neighbors::{Cloud, NeighborError, NeighborList, Periodic};

/// Distance of two particles below which they are beside each other, over the spacing: the diagonal of a
/// lattice, and less than two particles on both sides of a single layer of others.
pub const BESIDE: f64 = 1.6;

/// The periodic axes along which one of the particles at `positions` is connected to its own image by others.
///
/// # Errors
/// Particles that cannot be sorted into cells.
pub fn axes(positions: &[DVec3], spacing: f64, periodic: &Periodic) -> Result<[bool; 3], NeighborError> {
    let list = NeighborList::reference(Cloud::uniform(positions, BESIDE * spacing), periodic)?;
    let mut endless = [false; 3];
    // Displacement of the image of each particle at which a walk from the first of its piece has met it.
    let mut images: Vec<Option<DVec3>> = vec![None; positions.len()];
    for first in 0..positions.len() {
        if images[first].is_some() {
            continue;
        }
        images[first] = Some(DVec3::ZERO);
        let mut walk = vec![(first, DVec3::ZERO)];
        while let Some((i, image)) = walk.pop() {
            for &j in list.row(i) {
                let j = j as usize;
                let x_ij = positions[j] - positions[i];
                let there = image + periodic.minimal_image(x_ij) - x_ij;
                if let Some(met) = images[j] {
                    (0..3).for_each(|a| endless[a] |= (there[a] - met[a]).abs() > spacing);
                } else {
                    images[j] = Some(there);
                    walk.push((j, there));
                }
            }
        }
    }
    Ok(endless)
}
