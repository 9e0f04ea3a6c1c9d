//! Ellipsoids; ellipses in two dimensions: spheres that are stretched along the axes.

use std::f64::consts::PI;

use glam::DVec3;

use super::moments::Moments;
use super::region::{Aabb, Region};
use super::surface::{Surface, SurfacePoint};
use crate::linalg::Sym3;

/// Maximum number of steps of Newton's method, which needs less than ten except close to a centre of
/// curvature.
const STEPS: usize = 100;

/// An ellipsoid along the axes; in two dimensions an ellipse.
pub(super) struct StretchedSphere {
    center: DVec3,
    /// Half the lengths along the axes \[m\], zero along z in two dimensions.
    semi_axes: DVec3,
    axes: usize,
}

impl StretchedSphere {
    pub fn new(center: DVec3, semi_axes: DVec3, axes: usize) -> Self {
        let semi_axes = if axes == 3 { semi_axes } else { semi_axes.with_z(0.0) };
        Self { center, semi_axes, axes }
    }

    /// The nearest point of the surface to `arm`, both from the centre and with no component below zero.
    ///
    /// It is x_k = a_k^2 y_k / (a_k^2 + t) with the largest t for which it is on the surface (D. Eberly,
    /// Geometric Tools, Distance from a Point to an Ellipse, 2013). With u = t + min a_k^2 the condition is
    /// a convex and decreasing function of u > 0, so that Newton's method ascends to its root.
    fn foot(&self, arm: DVec3) -> DVec3 {
        let (a, axes) = (self.semi_axes, 0..self.axes);
        let shortest = axes.clone().map(|k| a[k]).fold(f64::INFINITY, f64::min);
        let excess = |k: usize| (a[k] - shortest) * (a[k] + shortest);
        let at = |u: f64, k: usize| if arm[k] == 0.0 { 0.0 } else { a[k] * a[k] * arm[k] / (u + excess(k)) };
        let share = |u: f64, k: usize| (at(u, k) / a[k]).powi(2);
        let mut u = axes.clone().filter(|k| a[*k] == shortest).map(|k| shortest * arm[k]).fold(0.0, f64::max);
        if u == 0.0 {
            // Across the plane of the longer axes the nearest point may lie above that plane.
            let rest = 1.0 - axes.clone().map(|k| share(0.0, k)).sum::<f64>();
            if rest >= 0.0 {
                let mut foot = DVec3::ZERO;
                axes.clone().for_each(|k| foot[k] = at(0.0, k));
                let up = axes.clone().find(|k| a[*k] == shortest).unwrap_or(0);
                foot[up] = shortest * rest.sqrt();
                return foot;
            }
        }
        for _ in 0..STEPS {
            let excess_of_sum = axes.clone().map(|k| share(u, k)).sum::<f64>() - 1.0;
            let slope: f64 =
                axes.clone().map(|k| 2.0 * share(u, k) / (u + excess(k)).max(f64::MIN_POSITIVE)).sum();
            let next = u + excess_of_sum / slope;
            if next > u {
                u = next;
            } else {
                break;
            }
        }
        let mut foot = DVec3::ZERO;
        axes.for_each(|k| foot[k] = at(u, k));
        foot
    }
}

impl Region for StretchedSphere {
    fn distance(&self, point: DVec3) -> f64 {
        let arm = point - self.center;
        let outside = (0..self.axes).map(|k| (arm[k] / self.semi_axes[k]).powi(2)).sum::<f64>() - 1.0;
        let mut beside = arm.abs();
        (self.axes..3).for_each(|k| beside[k] = 0.0);
        beside.distance(self.foot(beside)).copysign(outside)
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: self.center - self.semi_axes, max: self.center + self.semi_axes }
    }

    fn volume(&self) -> Option<f64> {
        let product: f64 = (0..self.axes).map(|k| self.semi_axes[k]).product();
        Some(if self.axes == 3 { 4.0 / 3.0 * PI * product } else { PI * product })
    }
}

impl Surface for StretchedSphere {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let arm = point - self.center;
        let (mut beside, mut slope) = (arm.abs(), DVec3::ZERO);
        (self.axes..3).for_each(|k| beside[k] = 0.0);
        let mut foot = self.foot(beside);
        for k in 0..self.axes {
            foot[k] = foot[k].copysign(arm[k]);
            slope[k] = foot[k] / (self.semi_axes[k] * self.semi_axes[k]);
        }
        SurfacePoint {
            point: self.center + foot,
            normal: slope.normalize(),
            signed_distance: self.distance(point),
        }
    }

    fn moments(&self) -> Option<Moments> {
        let volume = self.volume()?;
        // Of a homogeneous ball and of a disc, per volume and square of the radius.
        let share = if self.axes == 3 { 0.2 } else { 0.25 };
        let second = share * volume * self.semi_axes * self.semi_axes;
        Some(Moments { volume, center: self.center, second: Sym3::from_diagonal(second) })
    }
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::super::sphere::BallRegion;
    use super::*;

    /// The distance from points of the surface of an ellipse, found by search.
    fn searched(ellipse: &StretchedSphere, point: DVec3) -> f64 {
        let angles = (0..40_000).map(|i| 2.0 * PI * f64::from(i) / 40_000.0);
        let on = angles
            .map(|angle| ellipse.center + ellipse.semi_axes * DVec3::new(angle.cos(), angle.sin(), 0.0));
        on.map(|on| on.distance(point)).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn distances_are_those_to_the_nearest_point_of_an_ellipse() {
        let ellipse = StretchedSphere::new(DVec3::new(0.3, -0.2, 0.0), DVec3::new(1.0, 0.4, 1.0), 2);
        for (x, y) in (-6..7).flat_map(|i| (-6..7).map(move |j| (0.23 * f64::from(i), 0.11 * f64::from(j)))) {
            let point = ellipse.center + DVec3::new(x, y, 0.0);
            let (found, searched) = (ellipse.distance(point), searched(&ellipse, point));
            assert!((found.abs() - searched).abs() < 1e-6, "{point}: {found} and {searched}");
            assert_eq!(found < 0.0, x.powi(2) + (y / 0.4).powi(2) < 1.0, "{point}: {found}");
        }
    }

    #[test]
    fn a_spheroid_has_the_distances_of_the_ellipse_that_turns() {
        for (across, along) in [(0.5, 1.0), (1.0, 0.5)] {
            let spheroid = StretchedSphere::new(DVec3::ZERO, DVec3::new(across, along, across), 3);
            let ellipse = StretchedSphere::new(DVec3::ZERO, DVec3::new(across, along, 1.0), 2);
            for n in 0..64 {
                let point = 0.4 * DVec3::new(f64::from(n % 4), f64::from(n / 4 % 4), f64::from(n / 16));
                let flat = DVec3::new(point.x.hypot(point.z), point.y, 0.0);
                assert!((spheroid.distance(point) - ellipse.distance(flat)).abs() < 1e-12, "{point}");
            }
        }
    }

    #[test]
    fn the_end_of_an_axis_has_the_exact_distance() {
        let ellipse = StretchedSphere::new(DVec3::ZERO, DVec3::new(1.0, 0.6, 1.0), 2);
        for (point, distance) in
            [((0.95, 0.0), -0.05), ((1.3, 0.0), 0.3), ((0.0, 0.0), -0.6), ((1e-30, 0.7), 0.1)]
        {
            let found = ellipse.distance(DVec3::new(point.0, point.1, 0.0));
            assert!((found - distance).abs() < 1e-12, "{point:?}: {found}");
        }
    }

    #[test]
    fn nearest_points_are_on_the_ellipsoid_and_along_its_normal() {
        let a = DVec3::new(1.0, 0.6, 0.4);
        let ellipsoid = StretchedSphere::new(DVec3::new(0.1, 0.2, -0.3), a, 3);
        for n in 0..343 {
            let arm = 0.43 * (DVec3::new(f64::from(n % 7), f64::from(n / 7 % 7), f64::from(n / 49)) - 3.0);
            let found = ellipsoid.closest(ellipsoid.center + arm);
            let on = found.point - ellipsoid.center;
            assert!(((on / a).length_squared() - 1.0).abs() < 1e-12, "{arm}: {on}");
            let outward = (on / (a * a)).normalize();
            assert!((found.normal - outward).length() < 1e-12, "{arm}");
            let back = on + found.signed_distance * outward;
            assert!((back - arm).length() < 1e-9, "{arm}: {back}");
        }
    }

    #[test]
    fn moments_are_those_of_the_ball_stretched() {
        let ball = BallRegion { center: DVec3::ZERO, radius: 2.0, axes: 3 };
        let by = DVec3::new(0.5, 1.5, 3.0);
        let found = StretchedSphere::new(DVec3::ZERO, 2.0 * by, 3).moments().expect("a closed form");
        let ball = ball.moments().expect("a closed form");
        let Sym3 { xx, yy, zz, .. } = ball.second;
        let expected = Sym3::from_diagonal(DVec3::new(xx, yy, zz) * by * by * by.element_product());
        assert!((found.second - expected).to_matrix().abs_diff_eq(DMat3::ZERO, 1e-12 * expected.zz));
        assert!((found.volume / (ball.volume * by.element_product()) - 1.0).abs() < 1e-14);
    }
}
