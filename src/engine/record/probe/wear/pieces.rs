//! The largest piece of each part of a body that can fail: what has come off is no part of its surface.
//!
//! Particles that were next to each other at the start hang together as long as neither has failed or been
//! removed, and no more than the reach of a kernel lies between them.

use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use crate::plugin::{BodyPlan, SimBuilder};
use crate::world::{BodyId, Damage, MissingColumn, Position, Removed, World};

/// Distance at the start within which particles are next to each other, over the spacing: that of the
/// diagonals of a square lattice.
const NEXT: f64 = 1.5;
/// Distance over the spacing beyond which they do not hang together.
const TORN: f64 = 4.0;

/// The bodies that can fail.
pub(super) struct Pieces {
    bodies: Vec<FailingBody>,
    periodic: Periodic,
}

struct FailingBody {
    body: BodyId,
    /// The particles next to each other.
    list: NeighborList,
    /// The part of the body that each particle was in at the start: parts may be apart from then on.
    parts: Vec<usize>,
}

impl Pieces {
    /// Those of some bodies.
    ///
    /// # Errors
    /// The particles of a body have no neighbours that could be found.
    pub fn new(bodies: impl Iterator<Item = BodyId>, sim: &SimBuilder<'_>) -> Result<Self, NeighborError> {
        let periodic = sim.periodic();
        let listed = bodies.map(|body| sim.body(body)).filter(|body| body.can_fail()).map(|body| {
            let list = next_to_each_other(body, &periodic)?;
            let parts = connected(&list, body.sites.len(), |_, _| true);
            Ok(FailingBody { body: body.id, list, parts })
        });
        Ok(Self { bodies: listed.collect::<Result<_, NeighborError>>()?, periodic })
    }

    /// Whether there are any.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Of every particle of a body whether it is in the largest piece of its part; none of a body that cannot
    /// fail.
    pub fn largest(&self, world: &World, body: BodyId) -> Result<Option<Vec<bool>>, MissingColumn> {
        let Some(own) = self.bodies.iter().find(|own| own.body == body) else { return Ok(None) };
        let (view, rows) = world.body_view(body);
        let (position, damage) = (view.read::<Position>()?, view.read::<Damage>()?);
        let removed = view.read::<Removed>()?;
        let (position, count) = (&position[rows.clone()], rows.len());
        let is_there: Vec<bool> =
            { rows }.map(|row| removed[row] == Removed::NO && damage[row].0 < 1.0).collect();
        let reach = TORN * world.body(body).spacing;
        let pieces = connected(&own.list, count, |i, j| {
            let apart = || self.periodic.minimal_image(position[j].0 - position[i].0).length();
            is_there[i] && is_there[j] && apart() < reach
        });
        let mut sizes = vec![0_u32; count];
        for i in (0..count).filter(|&i| is_there[i]) {
            sizes[pieces[i]] += 1;
        }
        // The largest piece of every part, by its first particle; of several the first.
        let mut largest: Vec<usize> = (0..count).collect();
        for piece in 0..count {
            let most = &mut largest[own.parts[piece]];
            if sizes[piece] > sizes[*most] {
                *most = piece;
            }
        }
        Ok(Some((0..count).map(|i| is_there[i] && pieces[i] == largest[own.parts[i]]).collect()))
    }
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

/// Of every particle the first one that it is connected to, by pairs of the list that hold together.
fn connected(list: &NeighborList, count: usize, hold: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let mut roots = Roots((0..count).collect());
    for i in 0..count {
        for j in list.row(i).iter().map(|&j| j as usize).filter(|&j| j > i && hold(i, j)) {
            roots.join(i, j);
        }
    }
    (0..count).map(|i| roots.of(i)).collect()
}

/// For every particle an earlier one that it is connected to; the first one has itself.
struct Roots(Vec<usize>);

impl Roots {
    /// The first particle that a particle is connected to. The way to it becomes shorter.
    fn of(&mut self, mut i: usize) -> usize {
        let Self(next) = self;
        while next[i] != i {
            next[i] = next[next[i]];
            i = next[i];
        }
        i
    }

    fn join(&mut self, i: usize, j: usize) {
        let (i, j) = (self.of(i), self.of(j));
        self.0[i.max(j)] = i.min(j);
    }
}
