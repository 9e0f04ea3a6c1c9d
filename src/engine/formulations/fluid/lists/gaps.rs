//! Particles of bodies that are beside other bodies or walls: no particle of a fluid may fit between the two.
//!
//! Their lists hold all boundary particles around them, those of their own body too. They are built with the
//! lists of the flow, and are valid as long as these.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;

use super::drift::Drift;
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::world::BodyId;

/// Motion of a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SideMotion {
    /// It is a wall.
    Wall,
    /// It is a rigid body whose motion is prescribed.
    Prescribed,
    /// Forces.
    Free,
}

/// A boundary as the search for gaps sees it. A thin body has one for each of its sides.
#[derive(Clone, Debug)]
pub struct GapSide {
    pub body: BodyId,
    /// Its rows in the cloud.
    pub rows: Range<usize>,
    pub moves: SideMotion,
    /// Whether the fluid has no pressure in gaps beside it: those of deformable and of thin bodies.
    pub is_closed: bool,
}

/// The lists of particles beside gaps.
#[derive(Debug, Default)]
pub struct GapPairs {
    /// All boundaries, in the order of the cloud.
    sides: Vec<GapSide>,
    ends: Vec<u32>,
    search: NeighborSearch,
    /// The particles that are looked at, as rows of the cloud, and where they are, m.
    rows: Vec<usize>,
    targets: Vec<DVec3>,
    /// The particles, as rows of the cloud and of the list.
    pub particles: Vec<[u32; 2]>,
    /// Boundary particles around those that were looked at, of their own side and of other bodies, as rows of
    /// the cloud.
    pub list: NeighborList,
}

/// Search for the lists.
#[derive(Clone, Copy)]
pub struct GapSearch<'a> {
    pub positions: &'a [DVec3],
    /// The first so many positions are those of fluids.
    pub fluid: usize,
    /// The lists hold the pairs within these two distances, m.
    pub support: f64,
    pub skin: f64,
    pub periodic: &'a Periodic,
    /// The particles have been sorted into its cells.
    pub drift: &'a Drift,
}

impl GapPairs {
    /// Of these boundaries, whose rows begin behind those of the fluids.
    pub fn new(sides: Vec<GapSide>) -> Self {
        let first = sides.first().map_or(0, |side| side.rows.start);
        let ends = sides.iter().map(|side| (side.rows.end - first) as u32).collect();
        Self { sides, ends, ..Self::default() }
    }

    /// Whether there may ever be a gap.
    pub fn are_possible(&self) -> bool {
        let open = || self.sides.iter().filter(|side| !side.is_closed);
        open().any(|side| side.moves > SideMotion::Wall && open().any(|other| other.body != side.body))
    }

    /// Takes the motion of a body for prescribed.
    pub fn hold(&mut self, body: BodyId) {
        self.sides
            .iter_mut()
            .filter(|side| side.body == body)
            .for_each(|side| side.moves = SideMotion::Prescribed);
    }

    /// Share of the particle in row `i` in the force of the gap between it and that in row `j`: that of the
    /// freer of the two bodies counts, or both.
    pub fn share_of(&self, i: usize, j: usize) -> f64 {
        match self.side_of(i).moves.cmp(&self.side_of(j).moves) {
            Ordering::Less => 0.0,
            Ordering::Equal => 0.5,
            Ordering::Greater => 1.0,
        }
    }

    /// Whether the particle in row `i` takes part in the edges of the boundary of row `j`: its own, or that
    /// of another body. Where forces move both, a force that one hands over to the other would change the
    /// angular momentum, and so it would between the two sides of a thin body.
    pub fn have_edges(&self, i: usize, j: usize) -> bool {
        let (own, other) = (self.side_of(i), self.side_of(j));
        own.rows == other.rows || own.body != other.body && own.moves.min(other.moves) < SideMotion::Free
    }

    /// The boundary of a particle.
    pub fn side_of(&self, row: usize) -> &GapSide {
        side_of(&self.sides, row)
    }

    /// Builds the lists.
    pub fn build(&mut self, of: GapSearch<'_>) -> Result<(), NeighborError> {
        let GapSearch { positions, fluid, support, skin, periodic, drift } = of;
        self.particles.clear();
        if !self.are_possible() {
            return Ok(());
        }
        let Self { sides, ends, search, rows, targets, particles, list } = self;
        let is_open = |row: usize| Some(side_of(sides, row)).filter(|side| !side.is_closed);
        let label = |row| is_open(row).map_or(u32::MAX, |side| side.body.0 as u32);
        drift.rows_beside_others(fluid, label, rows);
        rows.retain(|&row| side_of(sides, row).moves > SideMotion::Wall);
        if rows.is_empty() {
            return Ok(());
        }
        targets.clear();
        targets.extend(rows.iter().map(|&i| positions[i]));
        search.sort(Cloud::uniform(&positions[fluid..], support), skin, periodic)?;
        search.of_others(targets, ends, skin, periodic, list)?;
        list.shift(fluid as u32);
        let is_other = |i: usize, j: usize| {
            let (own, side) = (side_of(sides, i), side_of(sides, j));
            !side.is_closed && side.body != own.body
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

fn side_of(sides: &[GapSide], row: usize) -> &GapSide {
    &sides[sides.partition_point(|side| side.rows.end <= row)]
}
