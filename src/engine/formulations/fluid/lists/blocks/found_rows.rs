//! Lists of the blocks that other ranks compute: the particles near the box of each, searched on request.

use super::lists::BlockLists;
use crate::neighbors::{Boxes, NeighborList, NeighborSearch, Periodic};

/// Sources for such lists.
pub struct OtherSources<'a> {
    /// The search that has sorted the fluids.
    pub search: &'a NeighborSearch,
    pub groups: &'a [u32],
    pub skin: f64,
    pub periodic: &'a Periodic,
    /// Neighbours of each fluid particle among the boundary particles, and those of each boundary particle
    /// among the fluids.
    pub walls: &'a NeighborList,
    pub boundary: &'a NeighborList,
}

impl BlockLists {
    /// Rows near the box of a block that another rank computes, in the order of its list.
    #[cold]
    pub fn row_of_others(&self, block: usize, sources: &OtherSources<'_>) -> &[u32] {
        self.others.found[block].get_or_init(|| self.find(block, sources))
    }

    fn find(&self, block: usize, sources: &OtherSources<'_>) -> Box<[u32]> {
        let &OtherSources { search, groups, skin, periodic, walls, boundary } = sources;
        let (table, fluids) = (&self.table, self.walls.rows());
        let mut near = NeighborList::default();
        if block < fluids {
            let (centers, halves) = (&table.centers[block..=block], &table.halves[block..=block]);
            let wanted = std::slice::from_ref(&(0..1));
            let boxes = Boxes { centers, halves, wanted, groups, sift: None };
            // The same search has succeeded for the blocks of this rank.
            let _ = search.of_more_boxes(boxes, skin, periodic, &mut near);
        }
        let (list, first) = if block < fluids { (walls, 0) } else { (boundary, walls.rows()) };
        let rows = table.rows[block].iter().flat_map(|&row| list.row(row as usize - first));
        let mut beside: Vec<u32> = rows.copied().collect();
        beside.sort_unstable();
        beside.dedup();
        near.indices().iter().chain(&beside).copied().collect()
    }
}
