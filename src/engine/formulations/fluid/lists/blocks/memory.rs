//! The blocks of a flow, and what their passes read and write.

use std::ops::Range;

use super::lists::BlockLists;
use super::record::{Packed, Units};
use crate::formulations::fluid::lists::NearRows;
use crate::pair::RateBounds;
use crate::parallel::{BLOCK, Lanes8, own_rows};
use crate::ranks::Halo;

/// The blocks of a flow, and what their passes read and write.
pub struct Blocks {
    pub lists: BlockLists,
    pub units: Units,
    pub packed: Vec<Packed>,
    /// Neighbours within the support of any particle of a block.
    pub near: NearRows,
    /// Rates of compression over the weight at r = 0.
    pub rates: Vec<Lanes8>,
    /// A bit for each particle of a block within reach of a boundary.
    pub close: Vec<u8>,
    /// Of each fluid, the blocks of other ranks that hold particles of this one.
    pub halos: Vec<Halo>,
    /// What the pass of the force sums for each block.
    pub forces: Vec<Lanes8>,
    /// The largest rates of the pair terms in blocks of the pass.
    pub fastest: Vec<RateBounds>,
    /// Whether thin bodies hide some of what is near from particles; the neighbours of every particle are then written down in every step.
    pub hides: bool,
}

impl Blocks {
    /// Those of a flow; `hides` says that thin bodies hide some of what is near from particles.
    pub fn new(units: Units, hides: bool) -> Self {
        Self {
            lists: BlockLists::new(units),
            units,
            packed: Vec::new(),
            near: NearRows::default(),
            rates: Vec::new(),
            close: Vec::new(),
            halos: Vec::new(),
            forces: Vec::new(),
            fastest: Vec::new(),
            hides,
        }
    }

    /// Makes room for the neighbours within the support: of the blocks, and, if they are wanted, of the particles.
    pub fn make_room(&mut self, of_particles: &mut NearRows) {
        let BlockLists { table, fluid, walls, counts, .. } = &self.lists;
        let most = |block: usize| fluid.row(block).len() + walls.row(block).len();
        self.near.make_room_for(table.rows.len(), most);
        self.halos.clear();
        self.halos.resize_with(table.ends.len(), Halo::default);
        if self.hides {
            self.near.keep_lanes();
            let most = |i: usize| {
                let (block, lane) = table.place(i);
                counts[block][lane] as usize + walls.row(block).len()
            };
            of_particles.make_room_for(table.particles(), most);
        }
    }

    /// Makes the halo of the fluid of that number, whose rows these are, unless it has the present one.
    pub fn make_halo(&mut self, number: usize, rows: &Range<usize>) {
        if self.halos[number].is_current() {
            return;
        }
        let table = &self.lists.table;
        let blocks = table.of_fluid(number);
        let mut wanted = vec![false; blocks.len()];
        own_rows(rows).for_each(|row| wanted[table.place(row).0 - blocks.start] = true);
        self.halos[number] = Halo::of(std::slice::from_ref(&(0..blocks.len())), BLOCK, &wanted);
    }

    /// Neighbours within the support of a fluid particle or one that shares its block, itself included.
    #[inline(always)]
    pub fn near_of(&self, row: usize) -> &[u32] {
        self.near.row(self.lists.table.place(row).0)
    }

    /// The same, where the neighbours of particles are not written down.
    #[inline(always)]
    pub fn shared_row(&self, row: usize) -> Option<&[u32]> {
        if self.hides { None } else { Some(self.near_of(row)) }
    }
}
