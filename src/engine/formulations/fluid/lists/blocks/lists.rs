//! The neighbours that the particles of a block have in common.
//!
//! The search finds what is near the box of a block; half of that, where particles are in disorder, is near none of its particles and left out here.

use glam::DVec3;

use super::record::{Own, Packed, Units, dot, pack_places};
use super::table::Table;
use crate::formulations::fluid::lists::{NearRows, NearWriter};
use crate::neighbors::{NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::parallel::{BlockLoop, EIGHT, EightLanes, Lanes8, for_each_block, run_blocks_on};

/// Room over the radius that round-off cannot take away.
const CERTAIN: f64 = 1.0 + 1e-5;

/// Lists of the blocks: rows of the cloud that are near any particle of each, its own particles included.
#[derive(Debug)]
pub struct Lists {
    pub table: Table,
    /// Fluids.
    pub fluid: NearRows,
    /// What bounds them.
    pub walls: NeighborList,
    units: Units,
    /// How many fluid particles are near each particle of a block.
    pub counts: Vec<[u32; EIGHT]>,
    /// What is near the boxes.
    candidates: NeighborList,
    places: Vec<Packed>,
}

/// What lists are built from.
pub struct Sources<'a> {
    /// Positions of the fluids, m, those that the search has sorted.
    pub positions: &'a [DVec3],
    /// Where each fluid ends.
    pub fluids: &'a [u32],
    pub support: f64,
    pub skin: f64,
    /// Whether all particles have one z.
    pub plane: bool,
    pub periodic: &'a Periodic,
}

impl Lists {
    /// Lists of blocks that measure places in these units.
    pub fn new(units: Units) -> Self {
        Self {
            table: Table::default(),
            fluid: NearRows::default(),
            walls: NeighborList::default(),
            units,
            counts: Vec::new(),
            candidates: NeighborList::default(),
            places: Vec::new(),
        }
    }

    /// Makes blocks and lists; `groups` are the ends of all bodies, `walls` the neighbours of each particle among what bounds the flow.
    pub fn build(
        &mut self,
        sources: &Sources<'_>,
        (search, groups): (&mut NeighborSearch, &[u32]),
        walls: &NeighborList,
    ) -> Result<(), NeighborError> {
        let Sources { positions, fluids, support, skin, plane, periodic } = *sources;
        let Self { table, fluid, walls: of_blocks, units, counts, candidates, places } = self;
        table.build(positions, fluids, support, periodic);
        search.of_boxes((&table.centers, &table.halves, groups), skin, periodic, candidates)?;
        of_blocks.join(&table.rows, walls);
        pack_places(places, positions, units);
        fluid.make_room(&[candidates]);
        let unit = units.length.to_array();
        let limit = ((support + skin) * CERTAIN).powi(2);
        let (table, candidates, places) = (&*table, &*candidates, &places[..]);
        counts.resize(table.rows.len(), [0; EIGHT]);
        let rows = (&mut counts[..], fluid.writer());
        for_each_block(rows, &mut Vec::new(), &|first, (counts, near): (&mut [_], NearWriter<'_>)| {
            run_blocks_on(plane, Sift { table, candidates, places, unit, limit, first, counts, near });
        });
        Ok(())
    }
}

/// Takes out of the candidates those that are near.
struct Sift<'a> {
    table: &'a Table,
    candidates: &'a NeighborList,
    places: &'a [Packed],
    unit: [f64; 3],
    limit: f64,
    first: usize,
    counts: &'a mut [[u32; EIGHT]],
    near: NearWriter<'a>,
}

impl BlockLoop for Sift<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        let Self { table, candidates, places, unit, limit, first, counts, mut near } = self;
        let unit = [a.splat(unit[0]), a.splat(unit[1]), a.splat(unit[2])];
        let limit = a.splat(limit);
        for (k, counts) in counts.iter_mut().enumerate() {
            let mut count = Lanes8::ZERO;
            let own = Own::new(places, &table.rows[first + k]);
            let mut row = near.row(k);
            for &j in candidates.row(first + k) {
                let x = own.to(a, &places[j as usize], &unit).x;
                let square = dot(a, &x, &x);
                row.push_if::<false>(j, a.below(square, limit));
                count = a.plus(count, a.where_below(square, limit, a.same(1.0)));
            }
            row.close();
            for lane in 0..EIGHT {
                counts[lane] = count.0[lane] as u32;
            }
        }
    }
}
