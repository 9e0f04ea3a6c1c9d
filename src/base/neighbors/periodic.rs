//! Periodic domains.

use glam::DVec3;

use super::NeighborError;
use crate::parallel::{FourLanes, Number, Vector};

pub(super) const AXIS_NAMES: [char; 3] = ['x', 'y', 'z'];

/// The periodic axes and their lengths. Positions need not lie inside the domain.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Periodic {
    min: DVec3,
    axes: [bool; 3],
    /// Zero on axes that are not periodic, so that the minimum image needs no branch.
    length: DVec3,
    inverse_length: DVec3,
}

impl Periodic {
    /// No periodic axis.
    pub const NONE: Self =
        Self { min: DVec3::ZERO, axes: [false; 3], length: DVec3::ZERO, inverse_length: DVec3::ZERO };

    /// A box from `min` to `max` (m), periodic along the `axes` that are true; bounds of other axes are
    /// ignored.
    ///
    /// # Errors
    /// [`NeighborError::PeriodicBounds`] where a periodic axis has no positive finite length.
    pub fn new(min: DVec3, max: DVec3, axes: [bool; 3]) -> Result<Self, NeighborError> {
        let mut periodic = Self { min: DVec3::ZERO, axes, ..Self::NONE };
        for a in (0..3).filter(|&a| axes[a]) {
            let length = max[a] - min[a];
            if !(length > 0.0 && length.is_finite() && (1.0 / length).is_finite()) {
                return Err(NeighborError::PeriodicBounds { axis: AXIS_NAMES[a], min: min[a], max: max[a] });
            }
            periodic.min[a] = min[a];
            periodic.length[a] = length;
            periodic.inverse_length[a] = 1.0 / length;
        }
        Ok(periodic)
    }

    /// True where the axis is periodic.
    pub const fn axes(&self) -> [bool; 3] {
        self.axes
    }

    /// True when at least one axis is periodic.
    pub fn any(&self) -> bool {
        self.axes != [false; 3]
    }

    /// Lengths (m) of the periodic axes, zero on the others.
    pub const fn lengths(&self) -> DVec3 {
        self.length
    }

    /// Inverse length (1/m) of the periodic axes, zero on the others.
    pub(super) const fn inverse_lengths(&self) -> DVec3 {
        self.inverse_length
    }

    /// Start (m) of the periodic axes, zero on the others.
    pub const fn min(&self) -> DVec3 {
        self.min
    }

    /// `x_ij` to the nearest image of j: every periodic component in -L/2 ..= L/2.
    #[inline]
    pub fn minimal_image(&self, x_ij: DVec3) -> DVec3 {
        x_ij - self.length * (x_ij * self.inverse_length).map(nearest_integer)
    }

    /// The same for the vectors in lanes.
    #[inline(always)]
    #[must_use]
    pub fn minimal_images<A: FourLanes>(&self, x_ij: Vector<A>) -> Vector<A> {
        let (length, inverse) = (self.length, self.inverse_length);
        Vector {
            x: minimal_images(x_ij.x, length.x, inverse.x),
            y: minimal_images(x_ij.y, length.y, inverse.y),
            z: minimal_images(x_ij.z, length.z, inverse.z),
        }
    }

    /// The periodic image of a position inside the box, `min <= x < max` on periodic axes.
    pub fn wrap(&self, position: DVec3) -> DVec3 {
        let mut wrapped = position - self.length * ((position - self.min) * self.inverse_length).floor();
        for a in (0..3).filter(|&a| self.axes[a]) {
            // Rounding may give the end of the box, which is equivalent to its start.
            if wrapped[a] >= self.min[a] + self.length[a] || wrapped[a] < self.min[a] {
                wrapped[a] = self.min[a];
            }
        }
        wrapped
    }
}

/// The spacing of doubles is one between 2^52 and 2^53, so adding and subtracting this constant rounds to the
/// nearest integer without a library call.
pub const SHIFT: f64 = 6755399441055744.0;

#[inline(always)]
fn nearest_integer(x: f64) -> f64 {
    (x + SHIFT) - SHIFT
}

/// Components to the nearest image in lanes.
#[inline(always)]
fn minimal_images<A: FourLanes>(x: Number<A>, length: f64, inverse: f64) -> Number<A> {
    x - (x * inverse + SHIFT - SHIFT) * length
}
