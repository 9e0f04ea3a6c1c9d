//! Sorting of fluid particles along a space-filling curve: neighbours in space stay neighbours in memory
//! while the fluid mixes.
//!
//! Rows of a body are permuted within the body, in all columns; [`ParticleId`](crate::world::ParticleId)
//! identifies the particles. A body whose rows a selection refers to keeps its order.

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::group::Group;
use crate::shapes::MortonSort;
use crate::world::World;

/// Builds of lists between two sorts of the particles: the fastest has then moved some six spacings along a
/// wall.
pub const BUILDS: u64 = 8;

/// Memory for sorting.
#[derive(Default)]
pub struct Sorter {
    curve: MortonSort,
    scratch: Vec<u8>,
}

impl Sorter {
    /// Sorts the fluids of the cloud, that are at these positions, and says whether there was one to sort.
    /// The cloud is then as before.
    pub fn sort(&mut self, cloud: &FlowCloud, positions: &[DVec3], world: &World) -> bool {
        let free = |group: &&Group| group.fluid().is_some() && !group.held;
        for group in cloud.groups.iter().filter(free) {
            let cell = world.body(group.body).spacing;
            let order = self.curve.order(&positions[group.cloud.clone()], DVec3::ZERO, cell);
            world.phase(group.phase).permute(group.rows.clone(), order, &mut self.scratch);
        }
        cloud.groups.iter().any(|group| free(&group))
    }
}
