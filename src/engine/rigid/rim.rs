//! Circles of bodies with a round outline.

use glam::{DQuat, DVec3};

/// Sine of the angle between a plane and the plane of a rim below which the rim lies flat: no point of it is
/// the lowest.
const FLAT: f64 = 1e-4;

/// A circle about an axis; without an axis a sphere.
#[derive(Clone, Copy, Debug)]
pub struct Rim {
    axis: DVec3,
    /// Radius, m.
    pub radius: f64,
}

impl Rim {
    /// A circle about that unit vector.
    pub fn new(axis: DVec3, radius: f64) -> Self {
        Self { axis, radius }
    }

    /// A sphere.
    pub(super) fn ball(radius: f64) -> Self {
        Self { axis: DVec3::ZERO, radius }
    }

    /// Whether it is a sphere.
    pub fn is_ball(&self) -> bool {
        self.axis == DVec3::ZERO
    }

    /// The same circle with its axis turned.
    pub fn turned(self, turn: DQuat) -> Self {
        Self { axis: turn * self.axis, ..self }
    }

    /// Two unit vectors in its plane, at right angles.
    pub fn axes(&self) -> (DVec3, DVec3) {
        self.axis.any_orthonormal_pair()
    }

    /// Unit vector along it at the end of an arm from the centre.
    pub fn ahead(&self, arm: DVec3) -> DVec3 {
        self.axis.cross(arm) / self.radius
    }

    /// From the centre to the point that is deepest behind a plane of that outward normal; none where the rim
    /// lies flat on it.
    pub fn lowest(&self, normal: DVec3) -> Option<DVec3> {
        let across = normal - self.axis * normal.dot(self.axis);
        let length = across.length();
        (length > FLAT).then(|| across * (-self.radius / length))
    }
}
