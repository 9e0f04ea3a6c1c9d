//! The selected particles of a body, with the positions at which functions of place are evaluated: those of
//! the reference configuration, or the present ones of a fluid and of a field in space.

use glam::DVec3;

use crate::neighbors::Periodic;
use crate::plugin::{BodyKind, Selection, SimBuilder};
use crate::world::{BodyId, MissingColumn, PhaseId, Position, World};

/// Selected particles of one body.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Body.
    pub body: BodyId,
    /// Rows in the phase of the body, ascending.
    pub rows: Vec<u32>,
    /// Reference position of each, m; of a fluid the place that [`Part::locate`] took last.
    pub points: Vec<DVec3>,
    /// Place of each particle of a solid or rigid body in space, m, which [`Part::locate`] took last; empty
    /// where functions are evaluated in the reference.
    here: Vec<DVec3>,
    /// Whether functions are evaluated where the particles are, as always in a fluid, which has no reference.
    pub in_space: bool,
    /// Rows at the start, ascending, of a fluid, which is sorted at times; empty for others.
    at_start: Vec<u32>,
    /// Which of these each row holds.
    numbers: Vec<u32>,
    /// Periods of the domain.
    periodic: Periodic,
}

impl Part {
    /// Number of the particle in the `n`-th row among those that were selected at the start.
    #[inline]
    pub fn number(&self, n: usize) -> usize {
        self.numbers.get(n).map_or(n, |&k| k as usize)
    }

    /// Takes the places as they are now in the domain, if functions are evaluated there.
    ///
    /// # Errors
    /// The phase has no positions.
    pub fn locate(&mut self, world: &World) -> Result<(), MissingColumn> {
        if self.in_space {
            let (view, _) = world.body_view(self.body);
            let position = view.read::<Position>()?;
            let flows = !self.at_start.is_empty();
            self.here.resize(if flows { 0 } else { self.rows.len() }, DVec3::ZERO);
            let places = if flows { &mut self.points } else { &mut self.here };
            for (place, &row) in places.iter_mut().zip(&self.rows) {
                *place = self.periodic.wrap(position[row as usize].0);
            }
        }
        Ok(())
    }

    /// The places at which functions are evaluated, m.
    pub fn places(&self) -> &[DVec3] {
        if self.here.is_empty() { &self.points } else { &self.here }
    }

    /// Finds the rows again after the body has been sorted, and puts `along`, one value a row or none, into
    /// their order; says whether there was anything to do.
    ///
    /// # Errors
    /// The phase has no particle ids.
    pub fn follow(&mut self, world: &World, along: &mut [DVec3]) -> Result<bool, MissingColumn> {
        let stood = self.numbers.iter().map(|&k| self.at_start[k as usize]);
        if world.are_in(self.body, self.rows.iter().copied().zip(stood))? {
            return Ok(false);
        }
        let places = world.places_now(self.body, &self.at_start)?;
        let reorder = |values: &mut [DVec3]| {
            let mut at_start = vec![DVec3::ZERO; self.numbers.len()];
            values.iter().zip(&self.numbers).for_each(|(value, &k)| at_start[k as usize] = *value);
            values.iter_mut().zip(&places).for_each(|(value, &(_, k))| *value = at_start[k as usize]);
        };
        reorder(&mut self.points);
        reorder(along);
        for (n, (row, k)) in places.into_iter().enumerate() {
            (self.rows[n], self.numbers[n]) = (row, k);
        }
        Ok(true)
    }
}

/// The parts of a selection.
pub(super) fn parts_of(selection: &Selection, sim: &SimBuilder<'_>) -> Vec<Part> {
    let part = |(id, rows): &(BodyId, Vec<u32>)| {
        let body = sim.body(*id);
        let points = rows.iter().map(|&row| body.sites[row as usize - body.rows.start].position).collect();
        let at_start = if body.kind == BodyKind::Fluid { rows.clone() } else { Vec::new() };
        let numbers = (0..at_start.len() as u32).collect();
        let in_space = body.kind == BodyKind::Fluid;
        Part {
            body: *id,
            rows: rows.clone(),
            points,
            here: Vec::new(),
            in_space,
            at_start,
            numbers,
            periodic: sim.periodic(),
        }
    };
    selection.parts.iter().map(part).collect()
}

/// The phases of the bodies of a selection.
pub(super) fn phases_of(selection: &Selection, sim: &SimBuilder<'_>) -> Vec<PhaseId> {
    sim.phases_of(&crate::world::BodySet::new(selection.parts.iter().map(|(id, _)| *id)))
}
