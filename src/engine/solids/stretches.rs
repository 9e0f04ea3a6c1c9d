//! The extreme stretches of a body, on which its stable step depends.

use crate::linalg::smallest_and_largest_stretch;
use crate::materials::Stretches;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::world::{Damage, DeformationGradient};

/// The extreme stretches of the particles of a body that have not failed: what is left of a failed one may have any shape.
pub(super) fn of_body(gradient: &[DeformationGradient], damage: Option<&[Damage]>) -> Stretches {
    let intact = |row: usize| damage.is_none_or(|damage| damage[row].0 < 1.0);
    sum_over_blocks(gradient, &|first, rows: &[DeformationGradient]| {
        let rows = rows.iter().zip(first..).filter(|(_, row)| intact(*row));
        rows.fold(Stretches::default(), |mut all, (row, _)| {
            let (smallest, largest) = smallest_and_largest_stretch(row.0);
            all.add(&Stretches { smallest, largest, least_volume: row.0.determinant() });
            all
        })
    })
}

impl BlockSum for Stretches {
    fn add(&mut self, next: &Self) {
        self.smallest = self.smallest.min(next.smallest);
        self.largest = self.largest.max(next.largest);
        self.least_volume = self.least_volume.min(next.least_volume);
    }
}
