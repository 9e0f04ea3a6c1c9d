//! Mean or sum of a field over a selection.

use crate::fields::ChosenField;
use crate::plugin::Selection;
use crate::schedule::Resources;
use crate::world::{MissingColumn, Removed, World};

/// A field taken over the particles of a selection, each with the same weight.
pub struct ParticleGauge {
    pub(super) selection: Selection,
    pub(super) field: ChosenField,
    /// The sum instead of the mean.
    pub(super) sum: bool,
}

impl ParticleGauge {
    /// Mean or sum over the particles that have not been removed, one number for each component; a mean over none is not
    /// a number. Sums run in row order, body by body.
    pub(super) fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let width = self.field.width();
        let mut total = vec![0.0; width];
        let mut count = 0_u32;
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (Some(&first), Some(&last)) = (rows.first(), rows.last()) else { continue };
            let values = self.field.read(world, resources, *body, first as usize..last as usize + 1)?;
            let removed = world.body_view(*body).0.read::<Removed>()?;
            for row in rows.iter().filter(|row| removed[**row as usize] == Removed::NO) {
                count += 1;
                let at = (row - first) as usize * width;
                for (sum, value) in total.iter_mut().zip(&values[at..at + width]) {
                    *sum += value;
                }
            }
        }
        if !self.sum {
            total.iter_mut().for_each(|value| *value /= f64::from(count));
        }
        Ok(total)
    }
}
