//! The largest of numbers, as a sum over blocks.

use bytemuck::{Pod, Zeroable};

use super::BlockSum;

/// The largest number so far; not a number as soon as one of them is none.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub struct Largest(pub f64);

impl Largest {
    /// The largest of numbers that are not negative.
    #[inline]
    pub fn of(numbers: impl Iterator<Item = f64>) -> Self {
        numbers.fold(Self::default(), |mut largest, number| {
            largest.add(&Self(number));
            largest
        })
    }
}

impl BlockSum for Largest {
    #[inline]
    fn add(&mut self, next: &Self) {
        // Not the larger one of the two by `max`, which would drop what is not a number.
        if next.0.is_nan() || next.0 > self.0 {
            self.0 = next.0;
        }
    }
}
