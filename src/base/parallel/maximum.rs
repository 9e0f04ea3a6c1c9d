//! The maximum as a reduction over blocks.

use bytemuck::{Pod, Zeroable};

use super::BlockSum;

/// The maximum so far; NaN as soon as one number is NaN.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Maximum(pub f64);

impl Maximum {
    /// The maximum of non-negative numbers.
    #[inline]
    pub fn of(numbers: impl Iterator<Item = f64>) -> Self {
        numbers.fold(Self::default(), |mut largest, number| {
            largest.add(&Self(number));
            largest
        })
    }
}

impl BlockSum for Maximum {
    #[inline]
    fn add(&mut self, next: &Self) {
        // `f64::max` is avoided, because it would discard NaN.
        if next.0.is_nan() || next.0 > self.0 {
            self.0 = next.0;
        }
    }
}
