//! Mean or sum of a field over a selection.

use crate::plugin::Selection;
use crate::record::fields::ChosenField;
use crate::schedule::Resources;
use crate::world::{MissingColumn, World};

/// A field taken over the particles of a selection, each with the same weight.
pub struct ParticleGauge {
    pub(super) selection: Selection,
    pub(super) field: ChosenField,
    /// The sum instead of the mean.
    pub(super) sum: bool,
}

impl ParticleGauge {
    /// Mean or sum, one number for each component. Sums run in row order, body by body.
    pub(super) fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let width = self.field.width();
        let mut total = vec![0.0; width];
        for (body, rows) in &self.selection.parts {
            let (Some(&first), Some(&last)) = (rows.first(), rows.last()) else { continue };
            let values = self.field.read(world, resources, *body, first as usize..last as usize + 1)?;
            for row in rows {
                let at = (row - first) as usize * width;
                for (sum, value) in total.iter_mut().zip(&values[at..at + width]) {
                    *sum += value;
                }
            }
        }
        if !self.sum {
            let count = self.selection.len() as f64;
            total.iter_mut().for_each(|value| *value /= count);
        }
        Ok(total)
    }
}
