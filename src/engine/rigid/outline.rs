//! Round outlines: of a disc, ring, ball or shell a sphere, of a stretched sphere an ellipsoid, of a cylinder
//! or tube its side.
//!
//! A body that rolls must not roll over corners. Where its outline is round its contact nodes are circles,
//! whose lowest point is known exactly, instead of points.

use glam::{DQuat, DVec3};

use super::ellipsoid::RigidEllipsoid;
use super::rim::Rim;
use super::round::Round;
use crate::shapes::Shape;
use crate::space::Dimension;

/// Distance from an outline within which a point is on it, over its radius.
const ON_IT: f64 = 1e-6;
/// The round surface that bounds a body towards the outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Outline {
    /// A sphere; in two dimensions a circle.
    Ball { center: DVec3, radius: f64 },
    /// An ellipsoid; in two dimensions an ellipse.
    Ellipsoid { center: DVec3, ellipsoid: RigidEllipsoid },
    /// The side of a cylinder between the centres of its ends.
    Side { ends: [DVec3; 2], radius: f64 },
}

impl Outline {
    /// The outline of a shape, if it is round. Holes of a body do not cut its surface.
    pub fn of(shape: &Shape, dimension: Dimension) -> Option<Self> {
        match shape {
            Shape::Sphere { center, radius: outer }
            | Shape::Ring { center, outer, .. }
            | Shape::Shell { center, outer, .. } => Some(Self::Ball { center: center.0, radius: *outer }),
            Shape::Cylinder { from, to, radius: outer } | Shape::Tube { from, to, outer, .. } => {
                Some(Self::Side { ends: [from.0, to.0], radius: *outer })
            }
            Shape::Difference(shape, _) => Self::of(shape, dimension),
            Shape::Translate { shape, by } => {
                Some(Self::of(shape, dimension)?.moved(DQuat::IDENTITY, 1.0, |x| x + by.0))
            }
            Shape::Rotate { shape, axis, angle_degrees, about } => {
                let turn = DQuat::from_axis_angle(axis.0.try_normalize()?, angle_degrees.to_radians());
                Some(Self::of(shape, dimension)?.moved(turn, 1.0, |x| about.0 + turn * (x - about.0)))
            }
            Shape::Scale { shape, by, about } => {
                let by = if dimension == Dimension::Three { by.0 } else { by.0.with_z(0.0) };
                let place = |x: DVec3| about.0 + by * (x - about.0);
                let is_even = by.x == by.y && (dimension == Dimension::Two || by.x == by.z);
                match (&**shape, is_even) {
                    (_, true) => Some(Self::of(shape, dimension)?.moved(DQuat::IDENTITY, by.x, place)),
                    (Shape::Sphere { center, radius }, false) => Some(Self::Ellipsoid {
                        center: place(center.0),
                        ellipsoid: RigidEllipsoid::new(by * *radius),
                    }),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// The same where `to` moves places, a turn and a change of lengths by a factor.
    fn moved(self, turn: DQuat, factor: f64, to: impl Fn(DVec3) -> DVec3) -> Self {
        match self {
            Self::Ball { center, radius } => Self::Ball { center: to(center), radius: factor * radius },
            Self::Ellipsoid { center, ellipsoid } => {
                Self::Ellipsoid { center: to(center), ellipsoid: ellipsoid.turned(turn).scaled(factor) }
            }
            Self::Side { ends, radius } => Self::Side { ends: ends.map(to), radius: factor * radius },
        }
    }

    /// Whether a place on the surface of the body is on the outline.
    pub fn holds(&self, x: DVec3) -> bool {
        let (distance, radius) = match self {
            Self::Ellipsoid { center, ellipsoid } => return ellipsoid.holds(x - *center, ON_IT),
            Self::Ball { center, radius } => (x.distance(*center), radius),
            Self::Side { ends: [from, to], radius } => {
                ((x - *from).reject_from(*to - *from).length(), radius)
            }
        };
        (distance - radius).abs() < ON_IT * radius
    }

    /// The centres of circles that represent it, not much more than a spacing apart, and their shape, or the
    /// centre of the ellipsoid.
    pub fn rounds(&self, spacing: f64) -> (Vec<DVec3>, Round) {
        match *self {
            Self::Ball { center, radius } => (vec![center], Round::Rim(Rim::ball(radius))),
            Self::Ellipsoid { center, ellipsoid } => (vec![center], Round::Ellipsoid(ellipsoid)),
            Self::Side { ends: [from, to], radius } => {
                let parts = (from.distance(to) / spacing).round().max(1.0) as usize;
                let at = |k: usize| from.lerp(to, k as f64 / parts as f64);
                ((0..=parts).map(at).collect(), Round::Rim(Rim::new((to - from).normalize(), radius)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tube_has_rims_from_end_to_end() {
        let tube = "Tube(from: (0.0, 0.0, 0.0), to: (0.0, 0.0, 2.0), inner: 0.5, outer: 1.0)";
        let turned = format!("Rotate(shape: {tube}, axis: (0.0, 1.0, 0.0), angle_degrees: 90.0)");
        let outline = Outline::of(&ron::from_str(&turned).expect("a shape"), Dimension::Three)
            .expect("a tube is round");
        let (centers, Round::Rim(rim)) = outline.rounds(0.3) else { panic!("no circles") };
        assert_eq!(centers.len(), 8);
        assert!(centers[7].distance(DVec3::new(2.0, 0.0, 0.0)) < 1e-12);
        let down = rim.lowest(DVec3::new(0.6, 0.8, 0.0)).expect("it stands");
        assert!(down.distance(DVec3::new(0.0, -1.0, 0.0)) < 1e-12, "{down}");
        assert!(outline.holds(centers[3] + down) && !outline.holds(centers[0]));
        assert_eq!(rim.lowest(DVec3::X), None);
    }
}
