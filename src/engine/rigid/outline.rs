//! Round outlines: of a disc, ring, ball or shell a sphere, of a cylinder or tube its side.
//!
//! A body that rolls must not roll over corners. Where its outline is round its contact nodes are circles,
//! whose lowest point is known exactly, instead of points.

use glam::{DQuat, DVec3};

use crate::shapes::Shape;

/// Distance from an outline within which a point is on it, over its radius.
const ON_IT: f64 = 1e-6;
/// Sine of the angle between a plane and the plane of a rim below which the rim lies flat: no point of it is
/// the lowest.
const FLAT: f64 = 1e-4;

/// The round surface that bounds a body towards the outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outline {
    /// A sphere; in two dimensions a circle.
    Ball { center: DVec3, radius: f64 },
    /// The side of a cylinder between the centres of its ends.
    Side { ends: [DVec3; 2], radius: f64 },
}

impl Outline {
    /// The outline of a shape, if it is round. Holes of a body do not cut its surface.
    pub fn of(shape: &Shape) -> Option<Self> {
        match shape {
            Shape::Sphere { center, radius: outer }
            | Shape::Ring { center, outer, .. }
            | Shape::Shell { center, outer, .. } => Some(Self::Ball { center: center.0, radius: *outer }),
            Shape::Cylinder { from, to, radius: outer } | Shape::Tube { from, to, outer, .. } => {
                Some(Self::Side { ends: [from.0, to.0], radius: *outer })
            }
            Shape::Difference(shape, _) => Self::of(shape),
            Shape::Translate { shape, by } => Some(Self::of(shape)?.moved(|x| x + by.0)),
            Shape::Rotate { shape, axis, angle_degrees, about } => {
                let turn = DQuat::from_axis_angle(axis.0.try_normalize()?, angle_degrees.to_radians());
                Some(Self::of(shape)?.moved(|x| about.0 + turn * (x - about.0)))
            }
            _ => None,
        }
    }

    fn moved(self, to: impl Fn(DVec3) -> DVec3) -> Self {
        match self {
            Self::Ball { center, radius } => Self::Ball { center: to(center), radius },
            Self::Side { ends, radius } => Self::Side { ends: ends.map(to), radius },
        }
    }

    /// Whether a place on the surface of the body is on the outline.
    pub fn holds(&self, x: DVec3) -> bool {
        let (distance, radius) = match self {
            Self::Ball { center, radius } => (x.distance(*center), radius),
            Self::Side { ends: [from, to], radius } => {
                ((x - *from).reject_from(*to - *from).length(), radius)
            }
        };
        (distance - radius).abs() < ON_IT * radius
    }

    /// The centres of circles that represent it, not much more than a spacing apart, and their shape.
    pub fn rims(&self, spacing: f64) -> (Vec<DVec3>, Rim) {
        match *self {
            Self::Ball { center, radius } => (vec![center], Rim { axis: DVec3::ZERO, radius }),
            Self::Side { ends: [from, to], radius } => {
                let parts = (from.distance(to) / spacing).round().max(1.0) as usize;
                let at = |k: usize| from.lerp(to, k as f64 / parts as f64);
                ((0..=parts).map(at).collect(), Rim::new((to - from).normalize(), radius))
            }
        }
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tube_has_rims_from_end_to_end() {
        let tube = "Tube(from: (0.0, 0.0, 0.0), to: (0.0, 0.0, 2.0), inner: 0.5, outer: 1.0)";
        let turned = format!("Rotate(shape: {tube}, axis: (0.0, 1.0, 0.0), angle_degrees: 90.0)");
        let outline = Outline::of(&ron::from_str(&turned).expect("a shape")).expect("a tube is round");
        let (centers, rim) = outline.rims(0.3);
        assert_eq!(centers.len(), 8);
        assert!(centers[7].distance(DVec3::new(2.0, 0.0, 0.0)) < 1e-12);
        let down = rim.lowest(DVec3::new(0.6, 0.8, 0.0)).expect("it stands");
        assert!(down.distance(DVec3::new(0.0, -1.0, 0.0)) < 1e-12, "{down}");
        assert!(outline.holds(centers[3] + down) && !outline.holds(centers[0]));
        assert_eq!(rim.lowest(DVec3::X), None);
    }
}
