//! The neighbours that the particles of a block have in common.

use glam::DVec3;

use super::others::{OtherRows, own_blocks};
use super::record::{Packed, Units, pack_places};
use super::seen::{see_fluid, see_walls};
use super::sift::NearTest;
use super::table::BlockTable;
use crate::formulations::fluid::lists::sides::Sides;
use crate::neighbors::{Boxes, NeighborError, NeighborList, NeighborSearch, Periodic};

/// Room over the radius that round-off cannot take away.
const CERTAIN: f64 = 1.0 + 1e-5;

/// Lists of the blocks: rows of the cloud that are near any particle of each, its own particles included.
/// They are there for the blocks of this rank alone; those of others are found when they are asked for.
#[derive(Debug, Default)]
pub struct BlockLists {
    pub table: BlockTable,
    /// Fluids.
    pub fluid: NeighborList,
    /// Boundary particles near the fluids.
    pub walls: NeighborList,
    /// For the blocks of boundaries, which come after those of fluids: the fluid particles near any particle
    /// of each. None where thin bodies hide some of them.
    pub boundary: NeighborList,
    /// Lists of other ranks' blocks.
    pub others: OtherRows,
    /// For each pair of `fluid` and of `walls`, a bit for each particle of the block that sees the neighbour;
    /// empty where all see it.
    seen: [Vec<u8>; 2],
    /// Which neighbours a block has already, while lists are joined.
    joined: Vec<u32>,
}

/// Sources of the lists.
pub struct ListSources<'a> {
    /// Positions of all particles, m; the search has sorted those of fluids.
    pub positions: &'a [DVec3],
    /// Where each body ends, fluids first.
    pub groups: &'a [u32],
    /// Where each fluid ends.
    pub fluids: &'a [u32],
    /// The neighbours of each fluid particle among the boundary particles.
    pub walls: &'a NeighborList,
    /// Those of each boundary particle among the fluid particles.
    pub boundary: &'a NeighborList,
    pub support: f64,
    pub skin: f64,
    /// Whether all particles have one z.
    pub plane: bool,
    pub periodic: &'a Periodic,
    /// Visibility beside thin bodies, with the boundary particles near each particle, visible or not.
    pub sides: Option<(Sides<'a>, NeighborList)>,
    /// Whether every rank needs all boundary particles.
    pub all_boundaries: bool,
}

impl BlockLists {
    /// The bits of the particles of a block that see its neighbours, fluids and boundary particles, where
    /// some hide.
    #[inline(always)]
    pub fn seen(&self, block: usize) -> (&[u8], &[u8]) {
        let [fluid, walls] = &self.seen;
        (&fluid[self.fluid.range(block)], &walls[self.walls.range(block)])
    }

    /// Builds blocks and lists. The records of blocks `packed` get the places of all fluid particles, in
    /// these units.
    pub fn build(
        &mut self,
        sources: &ListSources<'_>,
        search: &mut NeighborSearch,
        packed: &mut [Packed],
        units: &Units,
    ) -> Result<(), NeighborError> {
        let ListSources { positions, groups, fluids, walls, boundary, .. } = *sources;
        let ListSources { support, skin, plane, periodic, ref sides, all_boundaries, .. } = *sources;
        let Self { table, fluid, walls: of_blocks, boundary: of_boundaries, others, seen, joined } = self;
        let particles = fluids.last().copied().unwrap_or_default();
        table.build(positions, if sides.is_some() { fluids } else { groups }, support, periodic);
        let blocks = table.of_first_bodies(fluids.len());
        let (of_fluids, of_others) = table.rows.split_at(blocks);
        let own = own_blocks(table, |body| {
            // Whoever hides something from others looks at all, as does who looks at gaps.
            if body.end <= particles as usize { sides.is_some() } else { all_boundaries }
        });
        others.begin(own, table.rows.len());
        let packed = &mut packed[..particles as usize];
        pack_places(packed, &positions[..particles as usize], units);
        let limit = ((support + skin) * CERTAIN).powi(2);
        let near = NearTest { table, packed, unit: units.length.to_array(), limit, plane };
        let sift = |first: usize, ends: &mut [usize], found: &mut [u32]| near.sift(first, ends, found);
        let boxes = Boxes {
            centers: &table.centers[..blocks],
            halves: &table.halves[..blocks],
            wanted: others.own(),
            groups,
            sift: Some(&sift),
        };
        search.of_boxes(boxes, skin, periodic, fluid)?;
        of_blocks.join(of_fluids, |block| others.is_own(block), walls, 0, joined);
        let is_own = |block| others.is_own(blocks + block);
        of_boundaries.join(of_others, is_own, boundary, particles, joined);
        if let Some((sides, all_walls)) = sides {
            let [seen_fluid, seen_walls] = seen;
            see_fluid(seen_fluid, near, fluid, sides, all_walls);
            see_walls(seen_walls, of_fluids, of_blocks, walls);
        }
        Ok(())
    }
}
