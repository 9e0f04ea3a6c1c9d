//! The extreme stretches of a body, on which its stable step depends.

use std::ops::Range;

use glam::DMat3;

use crate::linalg::{ExtremeValues, extreme_stretches};
use crate::materials::Stretches;
use crate::parallel::{BlockSum, Maximum, sum_over_own_blocks};
use crate::world::{Damage, DeformationGradient};

/// What tells which particles of a body resist: those that have failed do not, nor do those that carry no
/// share of their stress, in the plane of a clamp. Both may have any shape.
#[derive(Clone, Copy)]
pub(super) struct Resisting<'a> {
    damage: Option<&'a [Damage]>,
    shares: &'a [f64],
}

impl<'a> Resisting<'a> {
    /// Of the rows of a body; shares of stress are empty where all carry all of it.
    pub fn of_rows(rows: Range<usize>, damage: Option<&'a [Damage]>, shares: &'a [f64]) -> Self {
        let damage = damage.map(|damage| &damage[rows.clone()]);
        Self { damage, shares: shares.get(rows).unwrap_or_default() }
    }

    fn has(&self, row: usize) -> bool {
        self.damage.is_none_or(|damage| damage[row].0 < 1.0)
            && self.shares.get(row).is_none_or(|share| *share > 0.0)
    }
}

/// The extreme stretches of the particles of a body that resist.
pub(super) fn of_body(gradient: &[DeformationGradient], resisting: Resisting<'_>) -> Stretches {
    sum_over_own_blocks(gradient, &|first, rows: &[DeformationGradient]| {
        let rows = rows.iter().zip(first..).filter(|(_, row)| resisting.has(*row));
        rows.fold(Stretches::default(), |mut all, (row, _)| {
            let ExtremeValues { smallest, largest } = extreme_stretches(row.0);
            let volume = row.0.determinant();
            all.add(&Stretches { smallest, largest, smallest_volume: volume, largest_volume: volume });
            all
        })
    })
}

/// The smallest principal stretch, at most one, of the particles of a body that resist, since their reference
/// configuration had the deformation gradients `reference`.
pub(super) fn min_stretch_since(
    gradient: &[DeformationGradient],
    reference: &[DMat3],
    resisting: Resisting<'_>,
) -> f64 {
    let rows = (gradient, reference);
    let most: Maximum =
        sum_over_own_blocks(rows, &|first, (now, then): (&[DeformationGradient], &[DMat3])| {
            let rows = now.iter().zip(then).zip(first..).filter(|(_, row)| resisting.has(*row));
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
