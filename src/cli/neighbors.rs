//! How many neighbours the particles of a body have.

use std::ops::Range;

use meshless_engine::glam::DVec3;
use meshless_engine::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic, Support};
use meshless_engine::world::{PhaseView, ReferencePosition, SupportRadius};

use super::failure::Failure;

/// Numbers of neighbours within one body, in its reference configuration.
pub struct Neighbors {
    /// Mean.
    pub mean: f64,
    /// Least.
    pub least: usize,
    /// Most.
    pub most: usize,
}

impl Neighbors {
    /// Counts the neighbours; none where the particles have no support radius.
    pub fn count(view: &PhaseView<'_>, rows: Range<usize>) -> Result<Option<Self>, Failure> {
        let (Ok(positions), Ok(support)) = (view.read::<ReferencePosition>(), view.read::<SupportRadius>())
        else {
            return Ok(None);
        };
        let positions: Vec<DVec3> = positions[rows.clone()].iter().map(|position| position.0).collect();
        let support: Vec<f64> = support[rows].iter().map(|radius| radius.0).collect();
        let cloud = Cloud { positions: &positions, support: Support::PerParticle(&support) };
        let mut list = NeighborList::default();
        NeighborSearch::default()
            .within(cloud, 0.0, &Periodic::NONE, &mut list)
            .map_err(|error| Failure::Run(error.to_string()))?;
        let counts: Vec<usize> = (0..positions.len()).map(|row| list.row(row).len()).collect();
        let (Some(&least), Some(&most)) = (counts.iter().min(), counts.iter().max()) else { return Ok(None) };
        let mean = counts.iter().sum::<usize>() as f64 / counts.len() as f64;
        Ok(Some(Self { mean, least, most }))
    }
}
