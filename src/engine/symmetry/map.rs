//! The map of a symmetry.

use glam::{DMat3, DVec3};

/// The map x -> S x + c with a diagonal S of signs: a mirror image, a shift by a period, or several of these
/// one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Map {
    /// Diagonal of S.
    pub signs: DVec3,
    /// c, m.
    pub shift: DVec3,
}

impl Map {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self { signs: DVec3::ONE, shift: DVec3::ZERO };

    /// The mirror image across the plane normal to an axis at a coordinate, m.
    pub fn mirror(axis: usize, at: f64) -> Self {
        let mut map = Self::IDENTITY;
        map.signs[axis] = -1.0;
        map.shift[axis] = 2.0 * at;
        map
    }

    /// The shift along an axis, m.
    pub fn shift(axis: usize, by: f64) -> Self {
        let mut map = Self::IDENTITY;
        map.shift[axis] = by;
        map
    }

    /// This map after another one.
    #[must_use]
    pub fn after(self, first: Self) -> Self {
        Self { signs: self.signs * first.signs, shift: self.signs * first.shift + self.shift }
    }

    /// The image of a place, m.
    pub fn place(&self, x: DVec3) -> DVec3 {
        self.signs * x + self.shift
    }

    /// The image of a vector; and of a vector at the image, the vector at its source.
    pub fn vector(&self, v: DVec3) -> DVec3 {
        self.signs * v
    }

    /// The image S A S of a tensor A.
    pub fn tensor(&self, a: DMat3) -> DMat3 {
        let signs = DMat3::from_diagonal(self.signs);
        signs * a * signs
    }
}
