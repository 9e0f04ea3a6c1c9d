//! The extreme stretches of a body, on which its stable step depends.

use glam::DMat3;

use crate::linalg::{ExtremeValues, extreme_stretches};
use crate::materials::Stretches;
use crate::parallel::{BlockSum, Maximum, sum_over_own_blocks};
use crate::world::{Damage, DeformationGradient};

/// The extreme stretches of the intact particles of a body: failed ones may have any shape.
pub(super) fn of_body(gradient: &[DeformationGradient], damage: Option<&[Damage]>) -> Stretches {
    let intact = |row: usize| damage.is_none_or(|damage| damage[row].0 < 1.0);
    sum_over_own_blocks(gradient, &|first, rows: &[DeformationGradient]| {
        let rows = rows.iter().zip(first..).filter(|(_, row)| intact(*row));
        rows.fold(Stretches::default(), |mut all, (row, _)| {
            let ExtremeValues { smallest, largest } = extreme_stretches(row.0);
            let volume = row.0.determinant();
            all.add(&Stretches { smallest, largest, smallest_volume: volume, largest_volume: volume });
            all
        })
    })
}

/// The smallest principal stretch, at most one, of the particles of a body that have not failed, since their
/// reference configuration had the deformation gradients `reference`.
pub(super) fn min_stretch_since(
    gradient: &[DeformationGradient],
    reference: &[DMat3],
    damage: Option<&[Damage]>,
) -> f64 {
    let intact = |row: usize| damage.is_none_or(|damage| damage[row].0 < 1.0);
    let rows = (gradient, reference);
    let most: Maximum =
        sum_over_own_blocks(rows, &|first, (now, then): (&[DeformationGradient], &[DMat3])| {
            let rows = now.iter().zip(then).zip(first..).filter(|(_, row)| intact(*row));
            Maximum::of(rows.map(|((now, then), _)| {
                let smallest = extreme_stretches(now.0 * then.inverse()).smallest;
                1.0 / smallest
            }))
        });
    1.0 / most.0.max(1.0)
}

impl BlockSum for Stretches {
    fn add(&mut self, next: &Self) {
        self.smallest = self.smallest.min(next.smallest);
        self.largest = self.largest.max(next.largest);
        self.smallest_volume = self.smallest_volume.min(next.smallest_volume);
        self.largest_volume = self.largest_volume.max(next.largest_volume);
    }
}
