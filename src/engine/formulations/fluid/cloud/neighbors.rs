//! The system that maintains the neighbour lists, and packs the particles for the passes.

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::sort::{BUILDS, Sorter};
use crate::column;
use crate::neighbors::NeighborError;
use crate::parallel::sum_over_blocks;
use crate::schedule::{Run, Step, StepError};
use crate::world::{MissingColumn, Removed, World};

column! {
    /// Position that the neighbour lists of a flow were built from: sums run in the order of the lists, and
    /// the same lists give the same bits.
    pub struct ListPosition(DVec3) = "list_position", "x_l", "m";
}

/// Label of the system that keeps the neighbour lists of fluids.
pub const NEIGHBORS: &str = "fluid_neighbors";

/// Keeps the lists and the packed rows of the cloud, and sorts the fluids at times.
#[derive(Default)]
pub struct Neighbors {
    /// Whether the lists still have to be restored from the checkpoint of the run.
    is_restored: bool,
    /// Positions that the lists have been built from, m.
    built: Vec<DVec3>,
    /// Number of builds since the particles were sorted.
    builds: u64,
    /// Number of particles of thin bodies that had been removed when the lists were built.
    removed: u64,
    sorter: Sorter,
}

impl FlowCloud {
    /// Builds the lists from these positions, and the memory for the neighbours within the support.
    fn build_lists(&mut self, positions: &[DVec3]) -> Result<(), NeighborError> {
        let Self { pairs, near, near_boundary, fluid, blocks, .. } = self;
        pairs.build(positions, *fluid, blocks.as_deref_mut())?;
        match blocks {
            Some(blocks) => blocks.allocate(near),
            None => near.allocate(&[&pairs.fluid, &pairs.walls]),
        }
        if blocks.as_ref().is_none_or(|blocks| blocks.hides) {
            near_boundary.allocate(&[&pairs.boundary]);
        }
        self.find_halo();
        Ok(())
    }

    /// Takes removed particles out of thin bodies, which hide nothing any more, and says how many they are.
    fn take_out_of_thin_bodies(&mut self, world: &World) -> Result<u64, MissingColumn> {
        let mut sum = 0;
        for thin in &mut self.pairs.thin {
            let group = self.groups.iter().find(|group| group.cloud == thin.copies[0]);
            if let Some(group) = group {
                let removed = world.phase(group.phase).read::<Removed>()?;
                sum += thin.take_out(&removed[group.rows.clone()]);
            }
        }
        Ok(sum)
    }

    /// Whether loops are no longer divided as they were when the lists were built.
    fn is_repartitioned(&self) -> bool {
        self.pairs.builds > 0 && self.blocks.as_ref().is_some_and(|blocks| !blocks.lists.others.is_current())
    }

    /// Reads the positions that the lists of an interrupted run were built from, m.
    fn read_list_positions(&self, world: &World, positions: &mut Vec<DVec3>) -> Result<(), MissingColumn> {
        positions.clear();
        for group in &self.groups {
            let column = world.phase(group.phase).read::<ListPosition>()?;
            positions.extend(column[group.rows.clone()].iter().map(|position| position.0));
        }
        Ok(())
    }

    /// Writes the positions that lists are built from to their columns.
    fn write_list_positions(&self, world: &World, positions: &[DVec3]) -> Result<(), MissingColumn> {
        for group in &self.groups {
            let mut column = world.phase(group.phase).write::<ListPosition>()?;
            let rows = (&mut column[group.rows.clone()], &positions[group.cloud.clone()]);
            sum_over_blocks(rows, &|_, (to, from): (&mut [ListPosition], &[DVec3])| {
                to.iter_mut().zip(from).for_each(|(to, from)| to.0 = *from);
            });
        }
        Ok(())
    }
}

impl Run for Neighbors {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        cloud.forget_loads();
        cloud.divide_boundaries(step.world);
        let is_known_otherwise = cloud.decide_for_step(step.world)?;
        let removed = cloud.take_out_of_thin_bodies(step.world)?;
        let is_worn = std::mem::replace(&mut self.removed, removed) != removed;
        let failed = |error: NeighborError| StepError::System {
            system: NEIGHBORS.to_owned(),
            message: error.to_string(),
        };
        let is_restored = std::mem::take(&mut self.is_restored);
        if is_restored || cloud.is_repartitioned() || is_known_otherwise && cloud.pairs.builds > 0 {
            cloud.read_list_positions(step.world, &mut self.built)?;
            cloud.build_lists(&self.built).map_err(failed)?;
            if !is_restored {
                cloud.pairs.builds -= 1;
            }
        }
        // After that, because lists leave the places that they are built from in the packed rows.
        let moved = cloud.pack(step.world)?;
        let FlowCloud { pairs, records, fluid, .. } = &mut *cloud;
        if pairs.are_stale(records, *fluid, moved, &self.built) || is_worn {
            cloud.read_positions(step.world, &mut self.built)?;
            if self.builds >= BUILDS && self.sorter.sort(&cloud, &self.built, step.world) {
                self.builds = 0;
                cloud.pack(step.world)?;
                // What is told apart now are rows of before and after, of a body that may have moved.
                cloud.is_still.fill(false);
                cloud.read_positions(step.world, &mut self.built)?;
            }
            cloud.write_list_positions(step.world, &self.built)?;
            cloud.build_lists(&self.built).map_err(failed)?;
            self.builds += 1;
        }
        cloud.share_records(step.world)?;
        cloud.average_motion(step.clock.dt);
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        [self.builds, self.removed].iter().flat_map(|count| count.to_le_bytes()).collect()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let Some((builds, rest)) = state.split_first_chunk() else { return false };
        let Ok(removed) = rest.try_into() else { return false };
        self.builds = u64::from_le_bytes(*builds);
        self.removed = u64::from_le_bytes(removed);
        // Before the first step there are no lists.
        self.is_restored = self.builds > 0;
        true
    }
}
