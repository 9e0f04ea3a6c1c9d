//! The neighbour lists of a flow: of every fluid particle among all particles, of every boundary particle
//! among the fluid.

use std::ops::Range;

use glam::DVec3;

use super::displacement_bounds::DisplacementBounds;
use super::drift::{Drift, Places, Skins};
use super::gaps::{GapPairs, GapSearch};
use super::sides::{Sides, ThinBody};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::formulations::fluid::lists::blocks::{BlockLists, Blocks, ListSources, OtherSources};
use crate::neighbors::{Cloud, FirstOfCloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::parallel::own_rows;
use crate::ranks;

/// Length of the cells in which particles move together, over the support.
const CELL: f64 = 2.0;
/// Room over the support that round-off cannot take away.
const CERTAIN: f64 = 1e-6;

/// Lists that contain every pair within the support as long as the relative displacement of neighbouring
/// particles is less than the skins.
#[derive(Debug)]
pub struct FlowPairs {
    skins: Skins,
    drift: Drift,
    periodic: Periodic,
    /// Where the bodies end, as rows of the cloud: rows of the lists are ordered by them.
    groups: Vec<u32>,
    /// The rows of the cloud that this rank computes, body by body; those of all fluids and of all boundaries
    /// in a program that runs alone.
    own: Vec<Range<usize>>,
    search: NeighborSearch,
    /// Fluid neighbours of each fluid particle.
    pub fluid: NeighborList,
    /// Neighbours of each fluid particle among the boundary particles, as rows of the cloud.
    pub walls: NeighborList,
    /// Fluid neighbours of each boundary particle; row 0 is the first particle after the fluid.
    pub boundary: NeighborList,
    /// Boundary particles beside gaps between bodies.
    pub gaps: GapPairs,
    plane: bool,
    /// How much particles that are near each other can at least still move against each other, m.
    remaining_skin: f64,
    /// Bodies whose sides do not see each other.
    pub thin: Vec<ThinBody>,
    /// Number of builds.
    pub builds: u64,
    /// Whether the ranks have been asked, since then, to divide boundaries by the fluid beside them.
    pub are_weighed: bool,
}

impl FlowPairs {
    pub fn new(skins: Skins, periodic: Periodic, groups: Vec<u32>, thin: Vec<ThinBody>, plane: bool) -> Self {
        Self {
            skins,
            drift: Drift::default(),
            periodic,
            groups,
            own: Vec::new(),
            search: NeighborSearch::default(),
            fluid: NeighborList::default(),
            walls: NeighborList::default(),
            boundary: NeighborList::default(),
            gaps: GapPairs::default(),
            remaining_skin: f64::NEG_INFINITY,
            thin,
            plane,
            builds: 0,
            are_weighed: true,
        }
    }

    /// Keeps lists of the particles beside gaps as well.
    pub fn with_gaps(mut self, gaps: GapPairs) -> Self {
        if gaps.are_possible() {
            self.skins.gaps = self.skins.walls;
        }
        self.gaps = gaps;
        self
    }

    /// Finds the rows that this rank computes.
    fn find_own(&mut self, fluid: usize) {
        let Self { groups, own, .. } = self;
        own.clear();
        if !ranks::has_several() {
            let end = groups.last().map_or(0, |&end| end as usize);
            own.extend([0..fluid, fluid..end]);
            return;
        }
        let starts = std::iter::once(0).chain(groups.iter().map(|&end| end as usize));
        let bodies = starts.zip(&*groups).map(|(start, &end)| start..end as usize);
        own.extend(bodies.map(|body| own_rows(&body)).filter(|own| !own.is_empty()));
    }

    /// Rows near a block that another rank computes.
    pub fn row_of_others<'b>(&self, lists: &'b BlockLists, block: usize) -> &'b [u32] {
        let Self { search, groups, skins, periodic, walls, boundary, .. } = self;
        let sources = OtherSources { search, groups, skin: skins.fluid, periodic, walls, boundary };
        lists.row_of_others(block, &sources)
    }

    #[inline]
    pub fn periodic(&self) -> &Periodic {
        &self.periodic
    }

    /// Whether a pair may be missing in the lists, or they never were built; the first `fluid` records are
    /// those of the fluid. `moved` says how far particles have moved since the question was last asked,
    /// `then` where they were when the lists were built, m.
    pub fn are_stale(
        &mut self,
        records: &[FlowParticle],
        fluid: usize,
        moved: DisplacementBounds,
        then: &[DVec3],
    ) -> bool {
        // Looking is needed when the particles may have used up the margin that they had when it was last
        // looked.
        self.remaining_skin -= moved.farthest(moved);
        if self.remaining_skin <= CERTAIN * self.skins.support {
            self.find_own(fluid);
            self.remaining_skin =
                self.drift.remaining_skin(Places { records, then }, &self.own, fluid, self.skins);
        }
        self.remaining_skin < 0.0
    }

    /// Builds the lists; the first `fluid` positions are those of the fluid. With `blocks`, fluids have those
    /// in the place of lists of their own.
    pub fn build(
        &mut self,
        positions: &[DVec3],
        fluid: usize,
        blocks: Option<&mut Blocks>,
    ) -> Result<(), NeighborError> {
        let Skins { support, fluid: skin, walls: wall_skin, .. } = self.skins;
        let (wet, dry) = (Cloud::uniform(&positions[..fluid], support), &positions[fluid..]);
        if blocks.is_some() {
            self.search.sort(wet, skin, &self.periodic)?;
        } else {
            let first = FirstOfCloud { cloud: wet, targets: fluid };
            self.search.of_first(first, &self.groups, skin, &self.periodic, &mut self.fluid)?;
        }
        self.search.of_others(dry, &self.groups, wall_skin, &self.periodic, &mut self.boundary)?;
        self.boundary.turn(0..fluid, &mut self.walls);
        self.walls.shift(fluid as u32);
        self.drift.sort(positions, CELL * support, &self.periodic);
        let Self { gaps, periodic, drift, .. } = self;
        gaps.build(GapSearch { positions, fluid, support, skin: wall_skin, periodic, drift })?;
        let mut hides = None;
        if !self.thin.is_empty() {
            let sides = Sides { thin: &self.thin, positions, periodic: &self.periodic, fluid };
            let walls = self.walls.clone();
            self.fluid.retain(|i, j| sides.sees(i, j as usize, &walls));
            self.walls.retain(|i, j| sides.sees(i, j as usize, &walls));
            self.walls.turn(fluid..positions.len(), &mut self.boundary);
            hides = Some((sides, walls));
        }
        if let Some(Blocks { lists, packed, units, .. }) = blocks {
            let ends = &self.groups;
            let sources = ListSources {
                positions,
                groups: ends,
                fluids: &ends[..ends.partition_point(|&end| end as usize <= fluid)],
                walls: &self.walls,
                boundary: &self.boundary,
                support,
                skin,
                plane: self.plane,
                periodic: &self.periodic,
                sides: hides,
                all_boundaries: !self.gaps.particles.is_empty(),
            };
            lists.build(&sources, &mut self.search, packed, units)?;
        }
        // The particles may have moved already: those of an interrupted run have.
        self.remaining_skin = f64::NEG_INFINITY;
        self.builds += 1;
        self.are_weighed = false;
        Ok(())
    }
}
