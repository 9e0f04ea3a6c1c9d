//! The blocks of a flow, and what their passes read and write.

use super::lists::BlockLists;
use super::record::{Packed, Units};
use crate::formulations::fluid::lists::NearRows;

/// The blocks of a flow, with input and output of their passes.
pub struct Blocks {
    pub lists: BlockLists,
    pub units: Units,
    pub packed: Vec<Packed>,
    /// Neighbours within the support of any particle of a block.
    pub near: NearRows,
    /// Whether thin bodies hide near particles from some; the neighbours of every particle are then recorded
    /// in every step, and boundaries have no blocks.
    pub hides: bool,
}

impl Blocks {
    /// Those of a flow of that many particles; `hides` says that thin bodies hide near particles from some.
    pub fn new(particles: usize, units: Units, hides: bool) -> Self {
        let packed = vec![Packed::default(); particles];
        Self { lists: BlockLists::default(), units, packed, near: NearRows::default(), hides }
    }

    /// Allocates memory for the neighbours within the support: of the blocks, and, if they are wanted, of the
    /// particles.
    pub fn allocate(&mut self, of_particles: &mut NearRows) {
        let BlockLists { table, fluid, walls, boundary, .. } = &self.lists;
        let most = |block: usize| match block.checked_sub(walls.rows()) {
            Some(block) => boundary.row(block).len(),
            None => fluid.row(block).len() + walls.row(block).len(),
        };
        self.near.allocate_rows(table.rows.len(), most);
        if self.hides {
            self.near.keep_lanes();
            let most = |i: usize| {
                let (block, lane) = table.place(i);
                let (seen, _) = self.lists.seen(block);
                seen.iter().filter(|&bits| bits >> lane & 1 == 1).count() + walls.row(block).len()
            };
            of_particles.allocate_rows(table.particles(), most);
        }
    }

    /// The block of a particle, where the neighbours of particles are not written down.
    #[inline(always)]
    pub fn shared_block(&self, row: usize) -> Option<usize> {
        if self.hides { None } else { Some(self.lists.table.place(row).0) }
    }
}
