//! The particles of a body that are in a box.

use glam::DVec3;

use crate::schedule::{Step, StepError};
use crate::shapes::Aabb;
use crate::world::{BodyId, Position, Removed};

/// Particles of a body, with memory that is kept.
#[derive(Default)]
pub(super) struct ParticlesIn {
    /// Their rows.
    pub rows: Vec<usize>,
    /// Where they are, m.
    pub places: Vec<DVec3>,
}

impl ParticlesIn {
    /// Makes it the particles of a body, those in a box alone.
    pub fn find(&mut self, step: &Step<'_>, body: BodyId, within: Option<&Aabb>) -> Result<(), StepError> {
        let (view, rows) = step.world.body_view(body);
        let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
        let is_in = |x: DVec3| within.is_none_or(|within| holds(within, x));
        let is_there = |row: &usize| removed[*row] == Removed::NO && is_in(position[*row].0);
        self.rows.clear();
        self.rows.extend(rows.filter(is_there));
        self.places.clear();
        self.places.extend(self.rows.iter().map(|row| position[*row].0));
        Ok(())
    }

    /// Leaves those in rows that are wanted.
    pub fn keep(&mut self, is_wanted: impl Fn(usize) -> bool) {
        let mut rows = self.rows.iter();
        self.places.retain(|_| rows.next().is_some_and(|&row| is_wanted(row)));
        self.rows.retain(|&row| is_wanted(row));
    }
}

/// Whether a point is in a box.
pub(super) fn holds(bounds: &Aabb, x: DVec3) -> bool {
    x.cmpge(bounds.min).all() && x.cmple(bounds.max).all()
}

/// The box around the particles of a body.
pub(super) fn bounds(step: &Step<'_>, body: BodyId) -> Result<Aabb, StepError> {
    let (view, rows) = step.world.body_view(body);
    let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
    Ok(Aabb::around(rows.filter(|row| removed[*row] == Removed::NO).map(|row| position[row].0)))
}
