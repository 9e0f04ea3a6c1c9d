//! Hollow spheres: the region between two concentric spheres.

use std::f64::consts::PI;

use glam::DVec3;

use super::moments::Moments;
use super::region::{Aabb, Region};
use super::rings::Rings;
use super::surface::{Surface, SurfacePoint, closest_between};
use crate::linalg::Sym3;

/// The region between two concentric spheres.
pub(super) struct Shell {
    pub center: DVec3,
    pub inner: f64,
    pub outer: f64,
}

impl Region for Shell {
    fn distance(&self, point: DVec3) -> f64 {
        let r = point.distance(self.center);
        (r - self.outer).max(self.inner - r)
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: self.center - self.outer, max: self.center + self.outer }
    }

    fn volume(&self) -> Option<f64> {
        Some(4.0 / 3.0 * PI * (self.outer.powi(3) - self.inner.powi(3)))
    }

    fn walls(&self) -> Vec<(&'static str, f64)> {
        vec![("the radius", self.outer - self.inner)]
    }

    fn rings(&self) -> Option<Rings> {
        Some(Rings::Shells { center: self.center, inner: self.inner, outer: self.outer })
    }
}

impl Surface for Shell {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        closest_between(self.center, self.inner, self.outer, point)
    }

    fn moments(&self) -> Option<Moments> {
        let square = 4.0 / 15.0 * PI * (self.outer.powi(5) - self.inner.powi(5));
        Some(Moments {
            volume: self.volume()?,
            center: self.center,
            second: Sym3::from_diagonal(DVec3::splat(square)),
        })
    }
}
