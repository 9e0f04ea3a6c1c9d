//! Particles of bodies that are beside other bodies or walls: no particle of a fluid may fit between the two.
//!
//! Their lists hold all boundary particles around them, those of their own body too. They are built with the lists of the flow, and are good for as long as these.

use std::ops::Range;

use glam::DVec3;

use super::drift::Drift;
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::world::BodyId;

/// A boundary as the search for gaps sees it. A thin body has one for each of its sides.
#[derive(Clone, Debug)]
pub struct Side {
    pub body: BodyId,
    /// Its rows in the cloud.
    pub rows: Range<usize>,
    /// Whether its gaps are looked for: those of bodies that the fluid moves, not of walls.
    pub is_moved: bool,
    /// Whether it is one side of a thin body.
    pub is_thin: bool,
    /// Whether there is no gap beside it.
    pub is_closed: bool,
}

/// The lists of particles beside gaps.
#[derive(Debug, Default)]
pub struct GapPairs {
    /// All boundaries, in the order of the cloud.
    sides: Vec<Side>,
    ends: Vec<u32>,
    search: NeighborSearch,
    /// The particles that are looked at, as rows of the cloud, and where they are, m.
    rows: Vec<usize>,
    targets: Vec<DVec3>,
    /// The particles, as rows of the cloud and of the list.
    pub particles: Vec<[u32; 2]>,
    /// Boundary particles around those that were looked at, of their own side and of other bodies, as rows of the cloud.
    pub list: NeighborList,
}

impl GapPairs {
    /// Of these boundaries, whose rows begin behind those of the fluids.
    pub fn new(sides: Vec<Side>) -> Self {
        let first = sides.first().map_or(0, |side| side.rows.start);
        let ends = sides.iter().map(|side| (side.rows.end - first) as u32).collect();
        Self { sides, ends, ..Self::default() }
    }

    /// Whether there may ever be a gap.
    pub fn are_possible(&self) -> bool {
        let open = || self.sides.iter().filter(|side| !side.is_closed);
        open().any(|side| side.is_moved && open().any(|other| other.body != side.body))
    }

    /// The boundary of a particle.
    pub fn side_of(&self, row: usize) -> &Side {
        side_of(&self.sides, row)
    }

    /// Builds the lists; the first `fluid` positions are those of fluids. They hold what is within `support` and `skin`, m, and of other bodies what a particle `sees`. The particles have been
    /// sorted into the cells of their `drift`.
    pub fn build(
        &mut self,
        (positions, fluid): (&[DVec3], usize),
        (support, skin): (f64, f64),
        (periodic, drift): (&Periodic, &Drift),
        sees: impl Fn(usize, usize) -> bool,
    ) -> Result<(), NeighborError> {
        self.particles.clear();
        if !self.are_possible() {
            return Ok(());
        }
        let Self { sides, ends, search, rows, targets, particles, list } = self;
        let is_open = |row: usize| Some(side_of(sides, row)).filter(|side| !side.is_closed);
        let label = |row| is_open(row).map_or(u32::MAX, |side| side.body.0 as u32);
        drift.rows_beside_others(fluid, label, rows);
        rows.retain(|&row| side_of(sides, row).is_moved);
        if rows.is_empty() {
            return Ok(());
        }
        targets.clear();
        targets.extend(rows.iter().map(|&i| positions[i]));
        search.sort(Cloud::uniform(&positions[fluid..], support), skin, periodic)?;
        search.of_others((&*targets, &*ends), skin, periodic, list)?;
        list.shift(fluid as u32);
        let is_other = |i: usize, j: usize| {
            let (own, side) = (side_of(sides, i), side_of(sides, j));
            !side.is_closed && side.body != own.body && sees(i, j)
        };
        list.retain(|k, j| {
            side_of(sides, rows[k]).rows.contains(&(j as usize)) || is_other(rows[k], j as usize)
        });
        for (k, &i) in rows.iter().enumerate() {
            let own = &side_of(sides, i).rows;
            if list.row(k).iter().any(|&j| !own.contains(&(j as usize))) {
                particles.push([i as u32, k as u32]);
            }
        }
        Ok(())
    }
}

fn side_of(sides: &[Side], row: usize) -> &Side {
    &sides[sides.partition_point(|side| side.rows.end <= row)]
}
