//! The selected particles of a body, with their positions in the reference configuration.

use glam::DVec3;

use crate::plugin::{Selection, SimBuilder};
use crate::world::{BodyId, PhaseId};

/// Selected particles of one body.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Body.
    pub body: BodyId,
    /// Rows in the phase of the body, ascending.
    pub rows: Vec<u32>,
    /// Reference position of each, m.
    pub points: Vec<DVec3>,
}

/// The parts of a selection.
pub(super) fn parts_of(selection: &Selection, sim: &SimBuilder<'_>) -> Vec<Part> {
    let part = |(id, rows): &(BodyId, Vec<u32>)| {
        let body = sim.body(*id);
        let points = rows.iter().map(|&row| body.sites[row as usize - body.rows.start].position).collect();
        Part { body: *id, rows: rows.clone(), points }
    };
    selection.parts.iter().map(part).collect()
}

/// The phases of the bodies of a selection.
pub(super) fn phases_of(selection: &Selection, sim: &SimBuilder<'_>) -> Vec<PhaseId> {
    sim.phases_of(&crate::world::BodySet::new(selection.parts.iter().map(|(id, _)| *id)))
}
