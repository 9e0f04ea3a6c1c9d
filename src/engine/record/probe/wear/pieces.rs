//! The largest piece of a body that can fail: what has come off is no part of its surface.
//!
//! Particles that were next to each other at the start hang together as long as neither has failed or been
//! removed, and no more than the reach of a kernel lies between them.

use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::plugin::{BodyPlan, SimBuilder};
use crate::world::{BodyId, Column, ColumnSet, Damage, MissingColumn, Position, Removed, World};

/// Distance at the start within which particles are next to each other, over the spacing: that of the
/// diagonals of a square lattice.
const NEXT: f64 = 1.5;
/// Distance over the spacing beyond which they do not hang together.
const TORN: f64 = 4.0;

/// The bodies that can fail, each with the particles next to each other.
pub(super) struct Pieces {
    bodies: Vec<(BodyId, NeighborList)>,
    periodic: Periodic,
}

impl Pieces {
    /// Those of some bodies.
    ///
    /// # Errors
    /// The particles of a body have no neighbours that could be found.
    pub fn new(bodies: impl Iterator<Item = BodyId>, sim: &SimBuilder<'_>) -> Result<Self, NeighborError> {
        let periodic = sim.periodic();
        let failing = bodies.filter(|&body| can_fail(sim.body(body)));
        let listed = failing.map(|body| Ok((body, next_to_each_other(sim.body(body), &periodic)?)));
        Ok(Self { bodies: listed.collect::<Result<_, NeighborError>>()?, periodic })
    }

    /// Whether there are any.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Of every particle of a body whether it is in the largest piece; none of a body that cannot fail.
    pub fn largest(&self, world: &World, body: BodyId) -> Result<Option<Vec<bool>>, MissingColumn> {
        let Some((_, list)) = self.bodies.iter().find(|(id, _)| *id == body) else { return Ok(None) };
        let (view, rows) = world.body_view(body);
        let (position, damage) = (view.read::<Position>()?, view.read::<Damage>()?);
        let removed = view.read::<Removed>()?;
        let (position, count) = (&position[rows.clone()], rows.len());
        let is_there: Vec<bool> =
            { rows }.map(|row| removed[row] == Removed::NO && damage[row].0 < 1.0).collect();
        let reach = TORN * world.body(body).spacing;
        let mut pieces = Roots((0..count as u32).collect());
        for i in (0..count).filter(|&i| is_there[i]) {
            for j in list.row(i).iter().map(|&j| j as usize).filter(|&j| j > i && is_there[j]) {
                if self.periodic.minimal_image(position[j].0 - position[i].0).length() < reach {
                    pieces.join(i, j);
                }
            }
        }
        let mut sizes = vec![0_u32; count];
        for i in (0..count).filter(|&i| is_there[i]) {
            sizes[pieces.of(i)] += 1;
        }
        let most = (0..count).rev().max_by_key(|&root| sizes[root]);
        Ok(Some((0..count).map(|i| is_there[i] && Some(pieces.of(i)) == most).collect()))
    }
}

fn can_fail(body: &BodyPlan) -> bool {
    let mut state = ColumnSet::default();
    body.solid_law().is_ok_and(|law| {
        law.state(&mut state);
        state.get(Damage::NAME).is_some()
    })
}

fn next_to_each_other(body: &BodyPlan, periodic: &Periodic) -> Result<NeighborList, NeighborError> {
    let places: Vec<_> = body.sites.iter().map(|site| site.position).collect();
    let mut list = NeighborList::default();
    NeighborSearch::default().within(
        Cloud::uniform(&places, NEXT * body.spacing),
        0.0,
        periodic,
        &mut list,
    )?;
    Ok(list)
}

/// For every particle another one of its piece, up to the root of the piece, which has itself.
struct Roots(Vec<u32>);

impl Roots {
    /// The root of the piece of a particle. The way to it becomes shorter.
    fn of(&mut self, mut i: usize) -> usize {
        let Self(next) = self;
        while next[i] as usize != i {
            next[i] = next[next[i] as usize];
            i = next[i] as usize;
        }
        i
    }

    fn join(&mut self, i: usize, j: usize) {
        let (i, j) = (self.of(i), self.of(j));
        self.0[i.max(j)] = i.min(j) as u32;
    }
}
