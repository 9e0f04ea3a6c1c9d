//! Mean or sum of a field over a selection.

use crate::fields::ChosenField;
use crate::plugin::Selection;
use crate::schedule::Resources;
use crate::world::{Column, Mass, MissingColumn, Removed, World, sum_by_row};

/// A field taken over the particles of a selection. A mean is weighted by mass: that of the positions of a
/// rigid body is its mass centre, and that of velocities is the momentum over the mass.
pub struct ParticleGauge {
    pub(super) selection: Selection,
    pub(super) field: ChosenField,
    /// The sum instead of the mean.
    pub(super) sum: bool,
}

impl ParticleGauge {
    /// Names of the columns that it reads.
    pub(super) fn needs(&self) -> Vec<&'static str> {
        let mut needs = self.field.needs();
        needs.push(Mass::NAME);
        needs
    }

    /// Mean or sum over the particles that have not been removed, one number for each component; a mean over
    /// none is not a number. Sums run along the tree of blocks, body by body.
    pub(super) fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let width = self.field.width();
        let mut total = vec![0.0; width];
        let mut weight = 0.0;
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (Some(&first), Some(&last)) = (rows.first(), rows.last()) else { continue };
            let values = self.field.read(world, resources, *body, first as usize..last as usize + 1)?;
            let (view, own) = world.body_view(*body);
            let (removed, mass) = (view.read::<Removed>()?, view.read::<Mass>()?);
            let (removed, mass) = (&removed[..], &mass[..]);
            let share = |row: u32| if self.sum { 1.0 } else { mass[row as usize].0 };
            let sum = |value: &(dyn Fn(usize) -> f64 + Sync)| {
                sum_by_row(own.len(), rows.len(), &|k| rows[k] as usize - own.start, &|k| {
                    let is_there = removed[rows[k] as usize] == Removed::NO;
                    if is_there { share(rows[k]) * value((rows[k] - first) as usize) } else { 0.0 }
                })
            };
            weight += sum(&|_| 1.0);
            for (component, total) in total.iter_mut().enumerate() {
                *total += sum(&|row| values[row * width + component]);
            }
        }
        if !self.sum {
            total.iter_mut().for_each(|value| *value /= weight);
        }
        Ok(total)
    }
}
