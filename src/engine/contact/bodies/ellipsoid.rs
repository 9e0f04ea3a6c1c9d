//! Where an ellipsoid is deepest below a surface.
//!
//! Its overlap is the depth of its deepest point. That is a minimum of the signed distance over the
//! ellipsoid, so that its derivative with a motion of the bodies is that at a fixed point of the ellipsoid,
//! and the force is the derivative of an energy. On a plane the deepest point is known at once; elsewhere the
//! normal of the ellipsoid at that point is against that of the surface, and steps along the difference lead
//! there. In a groove there are several such points, of which the deepest touches.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::rigid::RigidEllipsoid;
use crate::shapes::{Surface, SurfacePoint};

/// Difference of two directions on the sphere that was stretched, below which they are one.
const ALIKE: f64 = 1e-10;
/// The same, from which on the point is below a ridge: there edges touch.
const SMOOTH: f64 = 1e-5;
/// Steps to the deepest point; there are some five beside a ball, and twenty beside a small one.
const STEPS: usize = 100;
/// Longest step over the difference, and how often a step is halved.
const LONGEST: f64 = 4.0;
const HALVINGS: usize = 30;
/// Difference of two distances that is round-off, over the largest length of the ellipsoid.
const ROUND_OFF: f64 = 1e-15;

/// Places at which a surface that is not convex is looked at, in two and three dimensions.
const PLACES: [usize; 2] = [16, 48];
/// Descents from such places at most, cosine of the angle between their starts, and how much higher than the
/// deepest point found they may start, over the largest length.
const OTHERS: usize = 4;
const APART: f64 = 0.75;
const HIGHER: f64 = 0.1;

/// An ellipsoid beside a surface, in the reference configuration of that.
pub(super) struct EllipsoidBeside<'a> {
    pub surface: &'a dyn Surface,
    pub center: DVec3,
    pub ellipsoid: RigidEllipsoid,
}

/// Where a descent has come to.
#[derive(Clone, Copy)]
struct Reached {
    direction: DVec3,
    found: SurfacePoint,
    /// Whether the surface there is no ridge.
    is_smooth: bool,
}

impl EllipsoidBeside<'_> {
    /// The point of the surface nearest to the deepest point of the ellipsoid; none where that is below a
    /// ridge.
    pub fn deepest(&self) -> Option<SurfacePoint> {
        let from_center = self.surface.closest(self.center);
        let first = self.ellipsoid.lowest(from_center.normal);
        let [_, longest] = self.ellipsoid.extremes();
        if from_center.signed_distance > 2.0 * longest {
            return Some(self.at(first));
        }
        let mut deepest = self.descend(first);
        // In a groove there are others, not below the nearest point of the surface.
        let mut tried = [DVec3::ZERO; 2 * OTHERS + 2];
        tried[..2].copy_from_slice(&[first, deepest.direction]);
        let mut distances = [f64::INFINITY; PLACES[1]];
        for (k, distance) in distances[..self.places()].iter_mut().enumerate() {
            *distance = self.at(self.place(k)).signed_distance;
        }
        for k in 1..=OTHERS {
            let Some((start, distance)) = self.lowest_away_from(&tried, &distances) else { break };
            if distance > deepest.found.signed_distance + HIGHER * longest {
                break;
            }
            let other = self.descend(start);
            tried[2 * k..2 * k + 2].copy_from_slice(&[start, other.direction]);
            if other.found.signed_distance < deepest.found.signed_distance {
                deepest = other;
            }
        }
        deepest.is_smooth.then_some(deepest.found)
    }

    /// The lowest one of places away from others, and its signed distance, m.
    fn lowest_away_from(&self, tried: &[DVec3], distances: &[f64]) -> Option<(DVec3, f64)> {
        let seen = (0..self.places()).map(|k| (self.place(k), distances[k]));
        let away = seen.filter(|(place, _)| tried.iter().all(|other| other.dot(*place) < APART));
        away.reduce(|least, next| if next.1 < least.1 { next } else { least })
    }

    fn places(&self) -> usize {
        PLACES[usize::from(!self.ellipsoid.is_flat())]
    }

    /// Direction to a place: evenly around an ellipse, along a spiral on an ellipsoid.
    fn place(&self, k: usize) -> DVec3 {
        let (part, count) = (k as f64 + 0.5, self.places() as f64);
        if self.ellipsoid.is_flat() {
            let (sine, cosine) = (TAU * part / count).sin_cos();
            return DVec3::new(cosine, sine, 0.0);
        }
        let height = 1.0 - 2.0 * part / count;
        let (sine, cosine) = (part * PI * (5f64.sqrt() - 1.0)).sin_cos();
        let across = (1.0 - height * height).sqrt();
        DVec3::new(across * cosine, across * sine, height)
    }

    /// Goes down from a direction to where the normals are against each other.
    fn descend(&self, start: DVec3) -> Reached {
        let [_, longest] = self.ellipsoid.extremes();
        let (mut direction, mut found) = (start, self.at(start));
        let (mut length, mut way) = (1.0, self.ellipsoid.lowest(found.normal) - direction);
        for _ in 0..STEPS {
            if way.length() < ALIKE {
                break;
            }
            let mut step = length;
            let next = (0..HALVINGS).find_map(|_| {
                let next = (direction + step * way).normalize_or(direction);
                let at = self.at(next);
                step *= 0.5;
                (at.signed_distance <= found.signed_distance + ROUND_OFF * longest).then_some((next, at))
            });
            let Some((next, at)) = next else { break };
            let next_way = self.ellipsoid.lowest(at.normal) - next;
            // The step that the last one would have needed (J. Barzilai, J. M. Borwein, 1988).
            let moved = next - direction;
            let fall = -moved.dot(next_way - way);
            length = if fall > 0.0 { (moved.length_squared() / fall).min(LONGEST) } else { 1.0 };
            (direction, found, way) = (next, at, next_way);
        }
        Reached { direction, found, is_smooth: way.length() < SMOOTH }
    }

    fn at(&self, direction: DVec3) -> SurfacePoint {
        self.surface.closest(self.center + self.ellipsoid.arm(direction))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::rigid::{Outline, Round};
    use crate::shapes::Shape;
    use crate::space::Dimension;

    fn shape(text: &str) -> Shape {
        ron::from_str(text).expect("a shape")
    }

    /// An ellipsoid turned about an oblique axis, against the signed distance at 200 000 places: it lies on a
    /// plane, a ball smaller than its radius of curvature, a long cylinder, in a bore, in a groove, and on a
    /// ridge.
    #[test]
    fn the_deepest_point_of_an_ellipsoid_is_found() {
        let text = "Rotate(shape: Scale(shape: Sphere(center: (0, 0, 0), radius: 1), by: (0.3, 0.2, 0.1)), axis: (1, 2, 0.5), angle_degrees: 40)";
        let outline = Outline::of(&shape(text), Dimension::Three).expect("it is round");
        let (centers, Round::Ellipsoid(ellipsoid)) = outline.rounds(0.05) else { panic!("no ellipsoid") };
        for (text, height, touches) in [
            ("HalfSpace(point: (0, 0, 0), normal: (0.2, 0.1, 1))", 0.15, true),
            ("Sphere(center: (0.05, 0, -0.03), radius: 0.03)", 0.14, true),
            ("Cylinder(from: (0, -1, -0.2), to: (0.1, 1, -0.2), radius: 0.2)", 0.15, true),
            ("Tube(from: (-1, 0, 0), to: (1, 0, 0), inner: 0.4, outer: 0.5)", -0.22, true),
            (
                "Extrusion(polygon: [(-1, 0.4), (0.05, -0.23), (0.5, 1), (1, -1), (-1, -1)], from: -1, to: 1)",
                0.0,
                true,
            ),
            ("Extrusion(polygon: [(-1, -1), (1, -1), (0, 0)], from: -1, to: 1)", 0.1, false),
        ] {
            let surface = shape(text).surface(Dimension::Three, Path::new("."), "shape").expect("a surface");
            let center = centers[0] + if touches { height * DVec3::Z } else { height * DVec3::Y };
            let found = EllipsoidBeside { surface: &*surface, center, ellipsoid }.deepest();
            let at = |k: u32| {
                let (z, angle) = (f64::from(k) / 1e5 - 1.0, f64::from(k) * PI * (5f64.sqrt() - 1.0) % TAU);
                let (sine, cosine) = angle.sin_cos();
                let flat = (1.0 - z * z).max(0.0).sqrt();
                surface
                    .closest(center + ellipsoid.arm(DVec3::new(flat * cosine, flat * sine, z)))
                    .signed_distance
            };
            let least = (0..=200_000).map(at).fold(f64::INFINITY, f64::min);
            assert!(least < -1e-4, "{text}: {least}");
            assert_eq!(found.is_some(), touches, "{text}: {found:?} {least}");
            // Nothing on the ellipsoid is deeper, and what is looked at comes near it.
            let is_least = |found: f64| (-1e-4..1e-9).contains(&(found - least));
            assert!(found.is_none_or(|found| is_least(found.signed_distance)), "{text}: {found:?} {least}");
        }
    }
}
