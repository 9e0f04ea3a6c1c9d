//! Numbers of neighbours of the particles of a body.

use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic, SupportRadii};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, ReferencePosition, SupportRadius};

use super::failure::CommandFailure;

/// Numbers of neighbours of the particles of one body.
pub struct NeighborCounts {
    /// Mean.
    pub mean: f64,
    /// Minimum.
    pub min: usize,
    /// Maximum.
    pub max: usize,
}

impl NeighborCounts {
    /// Counts the neighbours of the particles of a body: in the reference configuration for solids, in the
    /// current one for fluids. None if particles have no neighbour lists.
    pub fn count(sim: &Simulation, body: BodyId) -> Result<Option<Self>, CommandFailure> {
        if let Some(cloud) = FlowCloud::whole(sim.resources())
            && let Some(counts) = cloud.neighbor_counts(body)
        {
            return Ok(Self::of(&counts));
        }
        let (view, rows) = sim.world().body_view(body);
        let (Ok(positions), Ok(support)) = (view.read::<ReferencePosition>(), view.read::<SupportRadius>())
        else {
            return Ok(None);
        };
        let positions: Vec<DVec3> = positions[rows.clone()].iter().map(|position| position.0).collect();
        let support: Vec<f64> = support[rows].iter().map(|radius| radius.0).collect();
        let cloud = Cloud { positions: &positions, support: SupportRadii::PerParticle(&support) };
        let mut list = NeighborList::default();
        NeighborSearch::default()
            .within(cloud, 0.0, &Periodic::NONE, &mut list)
            .map_err(|error| CommandFailure::Run(error.to_string()))?;
        let counts: Vec<usize> = (0..positions.len()).map(|row| list.row(row).len()).collect();
        Ok(Self::of(&counts))
    }

    fn of(counts: &[usize]) -> Option<Self> {
        let (min, max) = (*counts.iter().min()?, *counts.iter().max()?);
        let mean = counts.iter().sum::<usize>() as f64 / counts.len() as f64;
        Some(Self { mean, min, max })
    }
}
