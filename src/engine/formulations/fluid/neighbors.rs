//! The system that keeps the neighbour lists, and packs the particles for the passes.

use glam::DVec3;

use super::cloud::FlowCloud;
use super::sort::{BUILDS, Sorter};
use super::surface_friction;
use crate::schedule::{Run, Step, StepError};

/// Keeps the lists and the packed rows of the cloud, and sorts the fluids at times.
#[derive(Default)]
pub(super) struct Neighbors {
    /// Positions that the lists of an interrupted run were built from, m.
    restored: Vec<DVec3>,
    /// The same of this run, for the next checkpoint.
    built: Vec<DVec3>,
    /// Number of builds since the particles were sorted.
    builds: u64,
    /// Whether a viscous fluid had a free surface at the last build.
    free_surface: bool,
    /// Smallest eigenvalues of the moment matrices: scratch memory.
    smallest: Vec<f64>,
    sorter: Sorter,
}

impl Run for Neighbors {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        cloud.read_positions(step.world)?;
        let failed = |error: crate::neighbors::NeighborError| StepError::System {
            system: super::systems::NEIGHBORS.to_owned(),
            message: error.to_string(),
        };
        let fluid = cloud.fluid;
        if self.restored.len() == cloud.positions.len() {
            // Sums run in the order of the lists, four neighbours at a time: the same lists give the same bits.
            cloud.pairs.build(&std::mem::take(&mut self.restored), fluid).map_err(failed)?;
        }
        let stale = cloud.pairs.is_stale(&cloud.positions);
        if stale {
            if self.builds >= BUILDS && self.sorter.sort(&cloud, step.world) {
                self.builds = 0;
                cloud.read_positions(step.world)?;
            }
            let FlowCloud { positions, pairs, .. } = &mut *cloud;
            pairs.build(positions, fluid).map_err(failed)?;
            self.built.clone_from(&pairs.built);
            self.builds += 1;
        }
        cloud.pack(step.world)?;
        cloud.average_motion(step.clock.dt);
        if stale {
            self.free_surface = surface_friction::is_needed(&cloud, &mut self.smallest);
        }
        cloud.free_surface = self.free_surface;
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        let mut bytes = self.builds.to_le_bytes().to_vec();
        bytes.push(u8::from(self.free_surface));
        bytes.extend_from_slice(bytemuck::cast_slice(&self.built));
        bytes
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Some((builds, [free_surface, positions @ ..])) = state.split_first_chunk() else { return false };
        let size = size_of::<DVec3>();
        if !positions.len().is_multiple_of(size) {
            return false;
        }
        self.builds = u64::from_le_bytes(*builds);
        self.free_surface = *free_surface != 0;
        self.restored = positions.chunks_exact(size).map(bytemuck::pod_read_unaligned).collect();
        self.built.clone_from(&self.restored);
        true
    }
}
