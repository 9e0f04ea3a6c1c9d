//! Where a circle of a rigid cylinder is deepest below a surface.
//!
//! The overlap of a circle is the depth of its deepest point. That is a minimum of the signed distance along
//! the circle, so that its derivative with a motion of the bodies is that at a fixed point of the circle: the
//! force is the derivative of an energy, wherever the surface is met. The point that is lowest over the plane
//! through the surface point nearest to the centre is the same where that plane bounds the other body. Where
//! it does not, because the circle is large and meets another face, the depth behind that plane may be half
//! of the body: a block that slid over the rim of a turntable was thrown off.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::rigid::Rim;
use crate::shapes::{Surface, SurfacePoint};

/// Number of places at which a circle is looked at first: at least, and at most.
const PLACES: [f64; 2] = [16.0, 720.0];
/// Difference of a distance and that from a plane below which a point is on that plane, over the radius.
const ON_PLANE: f64 = 1e-9;
/// Faces of which the lowest point is tried.
const FACES: usize = 4;
/// Slope of the surface along the circle at its deepest point, from which on that point is below a ridge.
const SMOOTH: f64 = 1e-6;
/// Bisections: they reduce the piece between two places to round-off.
const BISECTIONS: usize = 48;

/// A circle beside a surface, in the reference configuration of that.
pub(super) struct CircleBeside<'a> {
    pub surface: &'a dyn Surface,
    pub center: DVec3,
    pub rim: Rim,
    /// Largest distance between two places at which the circle is looked at first, m.
    pub size: f64,
}

impl CircleBeside<'_> {
    /// The point of the surface nearest to the deepest point of the circle; none where the circle lies flat
    /// on a face, and where that point is below a ridge: there edges touch, and with the motion of the
    /// bodies the point follows the ridge.
    pub fn deepest(&self) -> Option<SurfacePoint> {
        let from_center = self.surface.closest(self.center);
        if let Some(arm) = self.rim.lowest(from_center.normal) {
            let found = self.at(arm);
            if self.is_bounded_by(&from_center, arm, &found) {
                return Some(found);
            }
        }
        let (mut arm, step) = self.first()?;
        let mut found = self.at(arm);
        if found.signed_distance > self.size {
            return Some(found);
        }
        for _ in 0..FACES {
            let lowest = self.rim.lowest(found.normal)?;
            let next = self.at(lowest);
            if next.signed_distance > found.signed_distance {
                break;
            }
            let plane =
                SurfacePoint { signed_distance: found.signed_distance - arm.dot(found.normal), ..found };
            if self.is_bounded_by(&plane, lowest, &next) {
                return Some(next);
            }
            (arm, found) = (lowest, next);
        }
        self.between(arm, step)
    }

    fn at(&self, arm: DVec3) -> SurfacePoint {
        self.surface.closest(self.center + arm)
    }

    /// Whether the surface at the end of `arm` is that plane, of which the distance at the centre is given.
    fn is_bounded_by(&self, plane: &SurfacePoint, arm: DVec3, found: &SurfacePoint) -> bool {
        let of_plane = plane.signed_distance + arm.dot(plane.normal);
        (found.signed_distance - of_plane).abs() < ON_PLANE * self.rim.radius
    }

    /// The deepest one of places along the circle, and the angle between two of them, rad.
    fn first(&self) -> Option<(DVec3, f64)> {
        let Rim { radius, .. } = self.rim;
        let [least, most] = PLACES;
        let count = (TAU * radius / self.size).ceil().clamp(least, most) as usize;
        let (u, v) = self.rim.axes();
        let step = TAU / count as f64;
        let (mut deepest, mut k): (Option<(f64, DVec3)>, usize) = (None, 0);
        while k < count {
            let angle = k as f64 * step;
            let arm = radius * (angle.cos() * u + angle.sin() * v);
            let distance = self.at(arm).signed_distance;
            if deepest.is_none_or(|(least, _)| distance < least) {
                deepest = Some((distance, arm));
            }
            // Along the circle the distance changes by no more than the length of the arc.
            k += 1 + ((distance - self.size) / (radius * step)).max(0.0) as usize;
        }
        deepest.map(|(_, arm)| (arm, step))
    }

    /// The deepest point within an angle, rad, of a place, if the surface is smooth there.
    fn between(&self, arm: DVec3, step: f64) -> Option<SurfacePoint> {
        let Rim { radius, .. } = self.rim;
        let across = self.rim.ahead(arm);
        let turned = |angle: f64| angle.cos() * arm + radius * angle.sin() * across;
        let slope = |angle: f64| self.at(turned(angle)).normal.dot(self.rim.ahead(turned(angle)));
        let [mut low, mut high] = if slope(0.0) > 0.0 { [-step, 0.0] } else { [0.0, step] };
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if slope(middle) > 0.0 { high = middle } else { low = middle }
        }
        let middle = 0.5 * (low + high);
        (slope(middle).abs() < SMOOTH).then(|| self.at(turned(middle)))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::shapes::Shape;
    use crate::space::Dimension;

    /// The circle of radius 0.5 about a place in x-y, against the signed distance at half a million places:
    /// it touches a face from above, a box tilted by 3 degrees from below, a ball, a cylinder and the edge
    /// of a wedge, and it lies on the lower face of a box of which a side is nearer to its centre.
    #[test]
    fn the_deepest_point_of_a_circle_is_found() {
        let above = DVec3::new(0.2, 0.49, 0.0);
        for (text, center, touches) in [
            ("Box(min: (-1, -2, -1), max: (1, 0, 1))", above, true),
            (
                "Rotate(shape: Box(min: (0.4, -0.1, 0), max: (0.6, 0.1, 0.2)), axis: (0, 1, 0), angle_degrees: 3.0, about: (0.499, 0, 0))",
                DVec3::ZERO,
                true,
            ),
            ("Sphere(center: (0.55, 0.1, 0.1), radius: 0.15)", DVec3::ZERO, true),
            ("Cylinder(from: (0.6, -1, 0.1), to: (0.5, 1, -0.1), radius: 0.12)", DVec3::ZERO, true),
            ("Extrusion(polygon: [(-1, -1), (1, -1), (0.2, 0)], from: -1, to: 1)", above, false),
            ("Box(min: (0.4, -0.1, -0.02), max: (0.6, 0.1, 0.2))", DVec3::ZERO, false),
        ] {
            let shape: Shape = ron::from_str(text).expect("a shape");
            let surface = shape.surface(Dimension::Three, Path::new("."), "shape").expect("a surface");
            let circle =
                CircleBeside { surface: &*surface, center, rim: Rim::new(DVec3::Z, 0.5), size: 0.05 };
            let found = circle.deepest().map(|found| found.signed_distance);
            let at = |k: u32| {
                let (sine, cosine) = (f64::from(k) * TAU / 5e5).sin_cos();
                surface.closest(center + 0.5 * DVec3::new(cosine, sine, 0.0)).signed_distance
            };
            let least = (0..500_000).map(at).fold(f64::INFINITY, f64::min);
            assert!(least < -1e-5, "{text}: {least}");
            assert_eq!(found.is_some(), touches, "{text}: {found:?} {least}");
            assert!(found.is_none_or(|found| (found - least).abs() < 1e-9), "{text}: {found:?} {least}");
        }
    }
}
