//! The system that keeps the neighbour lists, and packs the particles for the passes.

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::sort::{BUILDS, Sorter};
use crate::neighbors::NeighborError;
use crate::schedule::{Run, Step, StepError};

/// Label of the system that keeps the neighbour lists of fluids.
pub const NEIGHBORS: &str = "fluid_neighbors";

/// Keeps the lists and the packed rows of the cloud, and sorts the fluids at times.
#[derive(Default)]
pub struct Neighbors {
    /// Positions that the lists of an interrupted run were built from, m.
    restored: Vec<DVec3>,
    /// Those that the lists of this run were built from, for the next checkpoint.
    built: Vec<DVec3>,
    /// Number of builds since the particles were sorted.
    builds: u64,
    sorter: Sorter,
}

impl FlowCloud {
    /// Builds the lists from these positions, and the room for the neighbours within the support.
    fn build_lists(&mut self, positions: &[DVec3]) -> Result<(), NeighborError> {
        let Self { pairs, near, near_boundary, fluid, blocks, .. } = self;
        pairs.build(positions, *fluid, blocks.as_mut().map(|blocks| &mut blocks.lists))?;
        match blocks {
            Some(blocks) => blocks.make_room(near),
            None => near.make_room(&[&pairs.fluid, &pairs.walls]),
        }
        near_boundary.make_room(&[&pairs.boundary]);
        Ok(())
    }
}

impl Run for Neighbors {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        cloud.forget_loads();
        let moved = cloud.pack(step.world)?;
        let failed = |error: NeighborError| StepError::System {
            system: NEIGHBORS.to_owned(),
            message: error.to_string(),
        };
        if self.restored.len() == cloud.records.len() {
            // Sums run in the order of the lists, four neighbours at a time: the same lists give the same bits.
            cloud.build_lists(&std::mem::take(&mut self.restored)).map_err(failed)?;
        }
        let FlowCloud { pairs, records, fluid, .. } = &mut *cloud;
        if pairs.are_stale(records, *fluid, moved) {
            cloud.read_positions(&mut self.built);
            if self.builds >= BUILDS && self.sorter.sort(&cloud, &self.built, step.world) {
                self.builds = 0;
                cloud.pack(step.world)?;
                cloud.read_positions(&mut self.built);
            }
            cloud.build_lists(&self.built).map_err(failed)?;
            self.builds += 1;
        }
        cloud.average_motion(step.clock.dt);
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        let mut bytes = self.builds.to_le_bytes().to_vec();
        bytes.extend_from_slice(bytemuck::cast_slice(&self.built));
        bytes
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Some((builds, positions)) = state.split_first_chunk() else { return false };
        let size = size_of::<DVec3>();
        if !positions.len().is_multiple_of(size) {
            return false;
        }
        self.builds = u64::from_le_bytes(*builds);
        self.restored = positions.chunks_exact(size).map(bytemuck::pod_read_unaligned).collect();
        self.built.clone_from(&self.restored);
        true
    }
}
