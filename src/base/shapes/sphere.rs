//! Spheres; discs in two dimensions.

use std::f64::consts::PI;

use glam::DVec3;

use super::moments::Moments;
use super::region::{Aabb, Region};
use super::rings::Rings;
use super::surface::{Surface, SurfacePoint};
use crate::linalg::Sym3;

/// A sphere; in two dimensions a disc.
pub(super) struct BallRegion {
    pub center: DVec3,
    pub radius: f64,
    pub axes: usize,
}

impl Region for BallRegion {
    fn distance(&self, point: DVec3) -> f64 {
        point.distance(self.center) - self.radius
    }

    fn bounds(&self) -> Aabb {
        let reach = DVec3::new(self.radius, self.radius, if self.axes == 3 { self.radius } else { 0.0 });
        Aabb { min: self.center - reach, max: self.center + reach }
    }

    fn volume(&self) -> Option<f64> {
        Some(if self.axes == 3 { 4.0 / 3.0 * PI * self.radius.powi(3) } else { PI * self.radius.powi(2) })
    }

    fn rings(&self) -> Option<Rings> {
        Some(if self.axes == 3 {
            Rings::Shells { center: self.center, inner: 0.0, outer: self.radius }
        } else {
            Rings::Plane { center: self.center, inner: 0.0, outer: self.radius }
        })
    }
}

impl Surface for BallRegion {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let normal = (point - self.center).try_normalize().unwrap_or(DVec3::X);
        SurfacePoint {
            point: self.center + self.radius * normal,
            normal,
            signed_distance: self.distance(point),
        }
    }

    fn moments(&self) -> Option<Moments> {
        let volume = self.volume()?;
        let square = volume * self.radius * self.radius;
        let second = if self.axes == 3 {
            DVec3::splat(square / 5.0)
        } else {
            DVec3::new(1.0, 1.0, 0.0) * (square / 4.0)
        };
        Some(Moments { volume, center: self.center, second: Sym3::from_diagonal(second) })
    }
}
