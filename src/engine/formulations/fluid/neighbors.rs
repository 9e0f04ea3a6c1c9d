//! The system that keeps the neighbour lists, and packs the particles for the passes.

use glam::DVec3;

use super::cloud::FlowCloud;
use crate::schedule::{Run, Step, StepError};

/// Keeps the lists and the packed rows of the cloud.
#[derive(Default)]
pub(super) struct Neighbors {
    /// Positions that the lists of an interrupted run were built from, m.
    restored: Vec<DVec3>,
    /// The same of this run, for the next checkpoint.
    built: Vec<DVec3>,
}

impl Run for Neighbors {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        cloud.read_positions(step.world)?;
        let FlowCloud { positions, pairs, fluid, .. } = &mut *cloud;
        let failed = |error: crate::neighbors::NeighborError| StepError::System {
            system: super::systems::NEIGHBORS.to_owned(),
            message: error.to_string(),
        };
        if self.restored.len() == positions.len() {
            // Sums run in the order of the lists, four neighbours at a time: the same lists give the same bits.
            pairs.build(&std::mem::take(&mut self.restored), *fluid).map_err(failed)?;
        }
        if pairs.is_stale(positions) {
            pairs.build(positions, *fluid).map_err(failed)?;
            self.built.clone_from(&pairs.built);
        }
        cloud.pack(step.world)?;
        cloud.average_motion(step.clock.dt);
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        bytemuck::cast_slice::<DVec3, u8>(&self.built).to_vec()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let size = size_of::<DVec3>();
        if !state.len().is_multiple_of(size) {
            return false;
        }
        self.restored = state.chunks_exact(size).map(bytemuck::pod_read_unaligned).collect();
        self.built.clone_from(&self.restored);
        true
    }
}
