//! Mean or sum of a field over a selection.

use crate::fields::ChosenField;
use crate::plugin::Selection;
use crate::schedule::Resources;
use crate::world::{Column, Mass, MissingColumn, ReferenceVolume, Removed, World, sum_by_row};

/// A field taken over the particles of a selection. A mean is weighted by mass: that of the positions of a
/// rigid body is its mass centre, and that of velocities is the momentum over the mass. Walls have no mass: a
/// mean over them alone is weighted by volume.
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
        needs.extend([Mass::NAME, ReferenceVolume::NAME]);
        needs
    }

    /// Mean or sum over the particles that have not been removed, one number for each component; a mean over
    /// none is not a number.
    pub(super) fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        if self.sum {
            return Ok(self.weighted(world, resources, |_: &Mass| 1.0)?.0);
        }
        let (mut total, mut weight) = self.weighted(world, resources, |mass: &Mass| mass.0)?;
        if weight == 0.0 {
            (total, weight) = self.weighted(world, resources, |volume: &ReferenceVolume| volume.0)?;
        }
        total.iter_mut().for_each(|value| *value /= weight);
        Ok(total)
    }

    /// Sum of the field times a weight, which is a function of a column, for each component, and that of the
    /// weights. Sums run along the tree of blocks, body by body.
    fn weighted<W: Column>(
        &self,
        world: &World,
        resources: &Resources,
        weight_of: impl Fn(&W) -> f64 + Sync,
    ) -> Result<(Vec<f64>, f64), MissingColumn> {
        let width = self.field.width();
        let mut total = vec![0.0; width];
        let mut weight = 0.0;
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (Some(&first), Some(&last)) = (rows.first(), rows.last()) else { continue };
            let values = self.field.read(world, resources, *body, first as usize..last as usize + 1)?;
            let (view, own) = world.body_view(*body);
            let (removed, weights) = (view.read::<Removed>()?, view.read::<W>()?);
            let (removed, weights) = (&removed[..], &weights[..]);
            let sum = |value: &(dyn Fn(usize) -> f64 + Sync)| {
                sum_by_row(own.len(), rows.len(), &|k| rows[k] as usize - own.start, &|k| {
                    let row = rows[k] as usize;
                    let is_there = removed[row] == Removed::NO;
                    if is_there { weight_of(&weights[row]) * value(row - first as usize) } else { 0.0 }
                })
            };
            weight += sum(&|_| 1.0);
            for (component, total) in total.iter_mut().enumerate() {
                *total += sum(&|row| values[row * width + component]);
            }
        }
        Ok((total, weight))
    }
}
