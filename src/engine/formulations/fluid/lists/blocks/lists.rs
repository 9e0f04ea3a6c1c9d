//! The neighbours that the particles of a block have in common.
//!
//! The search finds the particles near the box of a block; where particles are in disorder, half of them are
//! near none of its particles and left out here.

use glam::DVec3;

use super::others::{OtherRows, own_blocks};
use super::record::{OwnBlock, Packed, Units, dot, pack_places};
use super::seen::write_seen;
use super::table::{BlockTable, Rows};
use crate::formulations::fluid::lists::sides::Sides;
use crate::formulations::fluid::lists::{NearRows, NearWriter};
use crate::neighbors::{Boxes, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::parallel::{BlockLoop, EIGHT, EightLanes, Lanes8, for_each_block, run_blocks_on};

/// Room over the radius that round-off cannot take away.
const CERTAIN: f64 = 1.0 + 1e-5;

/// Lists of the blocks: rows of the cloud that are near any particle of each, its own particles included.
/// They are there for the blocks of this rank alone; those of others are found when they are asked for.
#[derive(Debug)]
pub struct BlockLists {
    pub table: BlockTable,
    /// Fluids.
    pub fluid: NearRows,
    /// Boundary particles near the fluids.
    pub walls: NeighborList,
    /// For the blocks of boundaries, which come after those of fluids: the fluid particles near any particle
    /// of each. None where thin bodies hide some of them.
    pub boundary: NeighborList,
    /// Lists of other ranks' blocks.
    pub others: OtherRows,
    /// For each pair of `walls`, a bit for each particle of the block that sees the neighbour; empty, as are
    /// the bits of `fluid`, where all see it.
    seen_walls: Vec<u8>,
    units: Units,
    /// How many fluid particles are near each particle of a block.
    pub counts: Vec<[u32; EIGHT]>,
    /// Particles near the boxes.
    candidates: NeighborList,
    places: Vec<Packed>,
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
    /// Lists of blocks that measure places in these units.
    pub fn new(units: Units) -> Self {
        Self {
            table: BlockTable::default(),
            fluid: NearRows::default(),
            walls: NeighborList::default(),
            boundary: NeighborList::default(),
            others: OtherRows::default(),
            seen_walls: Vec::new(),
            units,
            counts: Vec::new(),
            candidates: NeighborList::default(),
            places: Vec::new(),
            joined: Vec::new(),
        }
    }

    /// The bits of the particles of a block that see its neighbours, fluids and boundary particles, where
    /// some hide.
    #[inline(always)]
    pub fn seen(&self, block: usize) -> (&[u8], &[u8]) {
        (self.fluid.lanes(block), &self.seen_walls[self.walls.range(block)])
    }

    /// Builds blocks and lists.
    pub fn build(
        &mut self,
        sources: &ListSources<'_>,
        search: &mut NeighborSearch,
    ) -> Result<(), NeighborError> {
        let ListSources { positions, groups, fluids, walls, boundary, .. } = *sources;
        let ListSources { support, skin, plane, periodic, ref sides, all_boundaries, .. } = *sources;
        let Self {
            table,
            fluid,
            walls: of_blocks,
            boundary: of_boundaries,
            others,
            seen_walls,
            units,
            counts,
            candidates,
            places,
            joined,
        } = self;
        let particles = fluids.last().copied().unwrap_or_default();
        table.build(positions, if sides.is_some() { fluids } else { groups }, support, periodic);
        let blocks = table.of_first_bodies(fluids.len());
        let (of_fluids, of_others) = table.rows.split_at(blocks);
        let own = own_blocks(table, |body| {
            // Whoever hides something from others looks at all, as does who looks at gaps.
            if body.end <= particles as usize { sides.is_some() } else { all_boundaries }
        });
        others.begin(own, table.rows.len());
        let boxes = Boxes {
            centers: &table.centers[..blocks],
            halves: &table.halves[..blocks],
            wanted: others.own(),
            groups,
        };
        search.of_boxes(boxes, skin, periodic, candidates)?;
        of_blocks.join(of_fluids, |block| others.is_own(block), walls, 0, joined);
        let is_own = |block| others.is_own(blocks + block);
        of_boundaries.join(of_others, is_own, boundary, particles, joined);
        pack_places(places, &positions[..particles as usize], units);
        fluid.allocate(&[candidates]);
        if sides.is_some() {
            fluid.keep_lanes();
            write_seen(seen_walls, of_fluids, of_blocks, walls);
        }
        let unit = units.length.to_array();
        let limit = ((support + skin) * CERTAIN).powi(2);
        let (table, candidates, places) = (&*table, &*candidates, &places[..]);
        counts.resize(blocks, [0; EIGHT]);
        let rows = (&mut counts[..], fluid.writer());
        for_each_block(rows, &mut Vec::new(), &|first, (counts, near): (&mut [_], NearWriter<'_>)| {
            let sift = NeighborFilter { table, candidates, places, sides, unit, limit, first, counts, near };
            match sides {
                Some(_) => run_blocks_on(plane, FilterLoop::<true>(sift)),
                None => run_blocks_on(plane, FilterLoop::<false>(sift)),
            }
        });
        Ok(())
    }
}

/// The bits of those particles of a block, among the ones whose bits are set, that see a fluid particle.
fn visible_to(sides: &Sides<'_>, walls: &NeighborList, rows: &Rows, j: u32, near: usize) -> usize {
    let sees = |lane: &usize| near >> lane & 1 == 1 && sides.sees(rows[*lane] as usize, j as usize, walls);
    (0..EIGHT).filter(sees).fold(0, |bits, lane| bits | 1 << lane)
}

/// Takes out of the candidates those that are near.
struct NeighborFilter<'a> {
    table: &'a BlockTable,
    candidates: &'a NeighborList,
    places: &'a [Packed],
    sides: &'a Option<(Sides<'a>, NeighborList)>,
    unit: [f64; 3],
    limit: f64,
    first: usize,
    counts: &'a mut [[u32; EIGHT]],
    near: NearWriter<'a>,
}

/// `HIDDEN`: where some particles do not see all near ones.
struct FilterLoop<'a, const HIDDEN: bool>(NeighborFilter<'a>);

impl<const HIDDEN: bool> BlockLoop for FilterLoop<'_, HIDDEN> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        let NeighborFilter { table, candidates, places, sides, unit, limit, first, counts, mut near } =
            self.0;
        let unit = [a.splat(unit[0]), a.splat(unit[1]), a.splat(unit[2])];
        let limit = a.splat(limit);
        for (k, counts) in counts.iter_mut().enumerate() {
            let mut count = Lanes8::ZERO;
            let rows = &table.rows[first + k];
            let own = OwnBlock::new(places, rows);
            let mut row = near.row(k);
            for &j in candidates.row(first + k) {
                let x = own.to(a, &places[j as usize], &unit).x;
                let square = dot(a, &x, &x);
                let bits = a.below(square, limit);
                let bits = match sides {
                    Some((sides, walls)) if HIDDEN => visible_to(sides, walls, rows, j, bits),
                    _ => bits,
                };
                row.push_if::<HIDDEN>(j, bits);
                count = a.add(count, a.where_below(square, limit, a.same(1.0)));
            }
            row.close();
            for lane in 0..EIGHT {
                counts[lane] = count.0[lane] as u32;
            }
        }
    }
}
