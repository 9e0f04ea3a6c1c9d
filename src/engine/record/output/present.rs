//! Frames contain the particles that are still in the run.

use crate::world::{BodyId, MissingColumn, Removed, World};

/// The rows of a body that have not been removed, counted from its first; none where that is all of them.
pub(super) struct PresentRows(Option<Vec<usize>>);

impl PresentRows {
    pub fn of(world: &World, body: BodyId) -> Result<Self, MissingColumn> {
        let (view, rows) = world.body_view(body);
        let removed = &view.read::<Removed>()?[rows];
        if removed.iter().all(|row| *row == Removed::NO) {
            return Ok(Self(None));
        }
        Ok(Self(Some((0..removed.len()).filter(|&k| removed[k] == Removed::NO).collect())))
    }

    /// Leaves the values of these rows, `width` a row.
    pub fn keep<T: Copy>(&self, values: Vec<T>, width: usize) -> Vec<T> {
        match &self.0 {
            None => values,
            Some(rows) => {
                rows.iter().flat_map(|&k| values[k * width..(k + 1) * width].iter().copied()).collect()
            }
        }
    }
}
