//! Volume of the particles removed from the run.

use crate::parallel::sum_over_blocks;
use crate::plugin::Selection;
use crate::record::probe::measure::Measure;
use crate::schedule::Resources;
use crate::world::{Column, MissingColumn, ReferenceVolume, Removed, World};

/// The particles whose removal counts.
pub(super) struct RemovedVolume {
    pub selection: Selection,
    pub plane: bool,
}

impl Measure for RemovedVolume {
    fn columns(&self) -> Vec<(String, &'static str)> {
        vec![("volume".to_owned(), if self.plane { "m2" } else { "m3" })]
    }

    fn needs(&self) -> Vec<&'static str> {
        vec![Removed::NAME, ReferenceVolume::NAME]
    }

    fn read(&self, world: &World, _: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let mut sum = 0.0;
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (view, _) = world.body_view(*body);
            let (removed, volume) = (view.read::<Removed>()?, view.read::<ReferenceVolume>()?);
            let (removed, volume) = (&removed[..], &volume[..]);
            sum += sum_over_blocks(&rows[..], &|_, rows: &[u32]| {
                let gone = rows.iter().map(|&row| row as usize).filter(|&row| removed[row] == Removed::YES);
                gone.map(|row| volume[row].0).sum::<f64>()
            });
        }
        Ok(vec![sum])
    }
}
